// Extended position-based dynamics for points on rods: small sub-steps, one iteration (Macklin et al. 2019,
// Small Steps in Physics Simulation). Its run time is the unit for the times of problem 11.
#include <algorithm>
#include <vector>

#include "Method.h"

namespace lab {
namespace {

class Xpbd : public Simulation {
 public:
  explicit Xpbd(const Scene& scene) : m_gravity(scene.gravity) {
    for (const Body& body : scene.bodies) {
      m_points.push_back({body.position, body.velocity, body.motion == Motion::DYNAMIC ? 1 / body.mass : 0,
                          body.linear_drag / body.mass});
    }
    for (const Joint& joint : scene.joints) {
      m_rods.push_back({indexOf(joint.a, joint.anchor_a), indexOf(joint.b, joint.anchor_b),
                        length(joint.anchor_b - joint.anchor_a)});
    }
    m_before.resize(m_points.size());
  }

  static bool canExpress(const Scene& scene) {
    return scene.rigid() && !scene.joints.empty() && !scene.field &&
           std::all_of(scene.bodies.begin(), scene.bodies.end(),
                       [](const Body& b) { return b.shapes.empty(); }) &&
           std::all_of(scene.joints.begin(), scene.joints.end(),
                       [](const Joint& j) { return j.kind == Joint::Kind::ROD; });
  }

  void step(double tick, int substeps) override {
    const double h = tick / substeps;
    for (int i = 0; i < substeps; ++i) substep(h);
  }

  BodyState body(int index) const override {
    const Point& point = m_points[static_cast<std::size_t>(index)];
    return {point.position, point.velocity, 0, 0};
  }

 private:
  struct Point {
    Vec position;
    Vec velocity;
    double inverse_mass = 0;
    double drag = 0;  // 1/s
  };
  struct Rod {
    std::size_t a;
    std::size_t b;
    double length;
  };

  // Returns the index of the body's point. For the ground, adds a fixed point at the anchor.
  std::size_t indexOf(int body, Vec anchor) {
    if (body >= 0) return static_cast<std::size_t>(body);
    m_points.push_back({anchor, {}, 0, 0});
    return m_points.size() - 1;
  }

  void substep(double h) {
    for (std::size_t i = 0; i < m_points.size(); ++i) {
      Point& point = m_points[i];
      m_before[i] = point.position;
      if (point.inverse_mass == 0) continue;
      point.velocity = (1 / (1 + h * point.drag)) * (point.velocity + h * m_gravity);
      point.position = point.position + h * point.velocity;
    }
    for (const Rod& rod : m_rods) {
      Point& a = m_points[rod.a];
      Point& b = m_points[rod.b];
      const Vec between = b.position - a.position;
      const double distance = length(between);
      const Vec push = (distance - rod.length) / (distance * (a.inverse_mass + b.inverse_mass)) * between;
      a.position = a.position + a.inverse_mass * push;
      b.position = b.position - b.inverse_mass * push;
    }
    for (std::size_t i = 0; i < m_points.size(); ++i) {
      m_points[i].velocity = 1 / h * (m_points[i].position - m_before[i]);
    }
  }

  Vec m_gravity;
  std::vector<Point> m_points;
  std::vector<Vec> m_before;
  std::vector<Rod> m_rods;
};

const RegisteredMethod method({"xpbd", "XPBD rods", "1", Method::Kind::CANDIDATE,
                               [](const Scene& scene) -> SimulationPtr {
                                 return Xpbd::canExpress(scene) ? std::make_unique<Xpbd>(scene) : nullptr;
                               }});

}  // namespace
}  // namespace lab
