// Extended position-based dynamics of rigid bodies in small sub-steps, one sweep each, without compliance
// (Müller, Macklin, Chentanez, Jeschke, Kim 2020). Contacts are found once a tick.
#include <algorithm>
#include <cmath>

#include "ContactScene.h"

namespace lab {
namespace {

constexpr double kReach = 0.02;  // largest gap considered, in metres

class ContactXpbd : public ContactSolver {
 public:
  void step(ContactScene& scene, double tick, int substeps) override {
    const double h = tick / substeps;
    scene.find(tick, kReach);
    m_before.resize(scene.bodies.size());
    for (int i = 0; i < substeps; ++i) substep(scene, h);
  }

 private:
  struct Before {
    Vec2 position;
    Rotation rotation;
    double angle = 0;
  };

  void substep(ContactScene& scene, double h) {
    for (std::size_t i = 0; i < m_before.size(); ++i) {
      const ContactBody& body = scene.bodies[i];
      m_before[i] = {body.position, body.rotation, body.angle};
    }
    scene.kick(h);
    scene.drift(h);
    for (ContactPair& pair : scene.pairs) {
      for (ContactPoint& point : pair.used()) part(scene, pair, point);
      for (const ContactPoint& point : pair.used()) stick(scene, pair, point);
    }
    for (std::size_t i = 0; i < m_before.size(); ++i) {
      ContactBody& body = scene.bodies[i];
      if (!body.isPushed()) continue;
      body.velocity = (body.position - m_before[i].position) / h;
      body.spin = (body.angle - m_before[i].angle) / h;
    }
    for (const ContactPair& pair : scene.pairs) {
      for (const ContactPoint& point : pair.used()) calm(scene, pair, point);
      for (const ContactPoint& point : pair.used()) rub(scene, pair, point, h);
    }
  }

  // Moves overlapping bodies apart.
  static void part(ContactScene& scene, const ContactPair& pair, ContactPoint& point) {
    const ContactArms arms = armsOf(scene, pair, point);
    point.normal_impulse = 0;
    const double gap = gapOf(scene, pair, point, arms);
    if (gap > 0) return;
    point.normal_impulse = -gap * massOf(scene, pair, arms, pair.normal);
    shift(scene, pair, arms, point.normal_impulse * pair.normal);
  }

  // Moves the contact point back to its place at the start of the sub-step, if friction can hold it there.
  void stick(ContactScene& scene, const ContactPair& pair, const ContactPoint& point) const {
    if (point.normal_impulse == 0) return;
    const ContactArms arms = armsOf(scene, pair, point);
    const Vec2 tangent = naiad::physics::perpendicular(pair.normal);
    const Before& before_a = m_before[static_cast<std::size_t>(pair.a)];
    const Before& before_b = m_before[static_cast<std::size_t>(pair.b)];
    const ContactBody& a = scene.bodies[static_cast<std::size_t>(pair.a)];
    const ContactBody& b = scene.bodies[static_cast<std::size_t>(pair.b)];
    const Vec2 way_a = (a.position + arms.a) - (before_a.position + before_a.rotation * point.anchor_a);
    const Vec2 way_b = (b.position + arms.b) - (before_b.position + before_b.rotation * point.anchor_b);
    const double slip = -dot(way_b - way_a, tangent) * massOf(scene, pair, arms, tangent);
    if (std::abs(slip) > pair.friction * point.normal_impulse) return;
    shift(scene, pair, arms, slip * tangent);
  }

  // Removes the velocity caused by moving the bodies apart.
  static void calm(ContactScene& scene, const ContactPair& pair, const ContactPoint& point) {
    if (point.normal_impulse == 0) return;
    const ContactArms arms = armsOf(scene, pair, point);
    const double speed = dot(speedOf(scene, pair, arms), pair.normal);
    push(scene, pair, arms, -speed * massOf(scene, pair, arms, pair.normal) * pair.normal);
  }

  // Applies sliding friction.
  static void rub(ContactScene& scene, const ContactPair& pair, const ContactPoint& point, double h) {
    if (point.normal_impulse == 0) return;
    const ContactArms arms = armsOf(scene, pair, point);
    const Vec2 tangent = naiad::physics::perpendicular(pair.normal);
    const double slip = dot(speedOf(scene, pair, arms), tangent);
    const double most = pair.friction * point.normal_impulse / h;
    push(scene, pair, arms, std::clamp(-slip * massOf(scene, pair, arms, tangent), -most, most) * tangent);
  }

  std::vector<Before> m_before;
};

const RegisteredMethod method({"xpbd_contacts", "XPBD contacts", "1", Method::Kind::CANDIDATE,
                               makeContacts<ContactXpbd>});

}  // namespace
}  // namespace lab
