// Sequential impulses in small sub-steps, one sweep each, starting from the last sub-step's impulses.
// Contacts are found once a tick. One variant removes overlap by moving the bodies apart (nonlinear
// Gauss-Seidel), the other by a damped spring that changes velocities; a second sweep then removes its part
// of the velocities. From Catto, Solver2D (2024): TGS-NGS and Soft Step, with the parameters of Solver2D and
// Box2D 3.
#include <algorithm>
#include <numbers>

#include "ContactScene.h"

namespace lab {
namespace {

constexpr double kReach = 0.02;  // largest gap considered, in metres
constexpr double kSlop = 0.005;  // overlap that is allowed to remain, in metres

// A soft constraint as three coefficients. Its frequency is a fraction of the sub-step rate.
struct Softness {
  double bias = 0, mass = 1, impulse = 0;
};

Softness softnessOf(double hertz, double h) {
  constexpr double kDampingRatio = 10;
  const double omega = 2 * std::numbers::pi * hertz;
  const double sum = 2 * kDampingRatio + h * omega;
  const double stiff = h * omega * sum;
  return {omega / sum, stiff / (1 + stiff), 1 / (1 + stiff)};
}

class Sequential : public ContactSolver {
 public:
  explicit Sequential(bool turns) : m_turns(turns) {}
  void step(ContactScene& scene, double tick, int substeps) override {
    const double h = tick / substeps;
    scene.find(tick, kReach);
    for (int i = 0; i < substeps; ++i) {
      scene.kick(h);
      warm(scene);
      substep(scene, h);
    }
  }

 protected:
  virtual void substep(ContactScene& scene, double h) = 0;

  // `p_soft` points to two values: the first for contacts with bodies that nothing can push, the second for
  // all others. Null: rigid.
  void sweep(ContactScene& scene, double h, const Softness* p_soft) const {
    constexpr double kFastestPush = 3;  // m/s; limit of the speed at which overlaps are removed
    for (ContactPair& pair : scene.pairs) {
      const bool is_held = !scene.bodies[static_cast<std::size_t>(pair.a)].isPushed() ||
                           !scene.bodies[static_cast<std::size_t>(pair.b)].isPushed();
      for (ContactPoint& point : pair.used()) {
        const double gap = gapOf(scene, pair, point, armsOf(scene, pair, point));
        const ContactArms arms = leversOf(scene, pair, point);
        Softness soft;
        double bias = 0;
        if (gap > 0) {
          bias = gap / h;
        } else if (p_soft != nullptr) {
          soft = p_soft[is_held ? 0 : 1];
          bias = std::max(soft.bias * gap, -kFastestPush);
        }
        const double speed = dot(speedOf(scene, pair, arms), pair.normal);
        const double change =
            -point.normal_mass * soft.mass * (speed + bias) - soft.impulse * point.normal_impulse;
        const double now = std::max(point.normal_impulse + change, 0.0);
        push(scene, pair, arms, (now - point.normal_impulse) * pair.normal);
        point.normal_impulse = now;
      }
      const Vec2 tangent = naiad::physics::perpendicular(pair.normal);
      for (ContactPoint& point : pair.used()) {
        const ContactArms arms = leversOf(scene, pair, point);
        const double most = pair.friction * point.normal_impulse;
        const double change = -point.tangent_mass * dot(speedOf(scene, pair, arms), tangent);
        const double now = std::clamp(point.tangent_impulse + change, -most, most);
        push(scene, pair, arms, (now - point.tangent_impulse) * tangent);
        point.tangent_impulse = now;
      }
    }
  }

 private:
  ContactArms leversOf(const ContactScene& scene, const ContactPair& pair, const ContactPoint& point) const {
    return m_turns ? armsOf(scene, pair, point) : point.found;
  }

  void warm(ContactScene& scene) const {
    for (const ContactPair& pair : scene.pairs) {
      const Vec2 tangent = naiad::physics::perpendicular(pair.normal);
      for (const ContactPoint& point : pair.used()) {
        push(scene, pair, leversOf(scene, pair, point),
             point.normal_impulse * pair.normal + point.tangent_impulse * tangent);
      }
    }
  }

  bool m_turns;
};

class Projecting : public Sequential {
 public:
  Projecting() : Sequential(true) {}

 private:
  void substep(ContactScene& scene, double h) override {
    sweep(scene, h, nullptr);
    scene.drift(h);
    constexpr double kPart = 0.2;      // part of the overlap that a sub-step removes
    constexpr double kFarthest = 0.2;  // m; limit of such a shift
    for (const ContactPair& pair : scene.pairs) {
      for (const ContactPoint& point : pair.used()) {
        const ContactArms arms = armsOf(scene, pair, point);
        const double overlap = -kPart * (gapOf(scene, pair, point, arms) + kSlop);
        if (overlap <= 0) continue;
        shift(scene, pair, arms,
              std::min(overlap, kFarthest) * massOf(scene, pair, arms, pair.normal) * pair.normal);
      }
    }
  }
};

class SoftStep : public Sequential {
 public:
  SoftStep() : Sequential(false) {}

 private:
  void substep(ContactScene& scene, double h) override {
    constexpr double kHertz = 30;
    const double hertz = std::min(kHertz, 0.25 / h);
    const Softness soft[] = {softnessOf(2 * hertz, h), softnessOf(hertz, h)};
    sweep(scene, h, soft);
    scene.drift(h);
    sweep(scene, h, nullptr);
  }
};

const RegisteredMethod projecting({"tgs_ngs", "TGS, projected", "1", Method::Kind::CANDIDATE,
                                   makeContacts<Projecting>});
const RegisteredMethod soft_step({"soft_step", "soft step", "1", Method::Kind::CANDIDATE,
                                  makeContacts<SoftStep>});

}  // namespace
}  // namespace lab
