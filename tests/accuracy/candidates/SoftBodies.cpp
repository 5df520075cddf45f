// Soft bodies with three methods: the product's step (BDF2, a direct solution), that step with backward
// Euler, and extended position-based dynamics with one iteration (Macklin et al. 2019). All three have equal
// nodes and springs, so only the method differs.
#include <algorithm>
#include <cmath>
#include <vector>

#include "Method.h"
#include "physics/geometry/Index.h"
#include "physics/soft/SoftBuild.h"
#include "physics/soft/SoftElastic.h"
#include "physics/soft/SoftForces.h"
#include "physics/soft/SoftWorld.h"

namespace lab {
namespace {

namespace physics = naiad::physics;
using physics::at;

constexpr double kPerSecond = 30;  // ticks per second
constexpr double kPerSecondSquared = kPerSecond * kPerSecond;
/// Stiffness of a rod in N/m. The loads here stretch it by less than 1e-6.
constexpr double kRod = 1e9;

physics::Vec2 toTicks(Vec v, double scale) {
  return {v.x * scale, v.y * scale};
}

physics::SoftBody beamOf(const Beam& beam) {
  const double ei = beam.modulus * std::pow(beam.thickness, 3) / 12;
  const double ea = beam.modulus * beam.thickness;
  const double per_length = beam.density * beam.thickness;
  physics::SoftBody body = physics::makeBeam({}, {beam.length, 0}, beam.elements, ei / kPerSecondSquared,
                                             ea / kPerSecondSquared, per_length, true);
  const double first =
      std::pow(1.8751040687119612, 2) * std::sqrt(ei / per_length / std::pow(beam.length, 4));
  body.drag = 2 * beam.damping * first / kPerSecond;
  body.nodes.back().force = {0, -beam.tip_force / kPerSecondSquared};
  return body;
}

// Makes a net of the scene's points and rods. Anchors on the ground become pinned nodes.
physics::SoftBody netOf(const Scene& scene) {
  physics::SoftBody body;
  for (const Body& point : scene.bodies) {
    physics::SoftNode node;
    node.offset = toTicks(point.position, 1);
    node.velocity = toTicks(point.velocity, 1 / kPerSecond);
    node.mass = point.mass;
    node.is_pinned = point.motion != Motion::DYNAMIC;
    body.nodes.push_back(node);
    body.drag = point.linear_drag / point.mass / kPerSecond;
  }
  const auto nodeOf = [&](int index, Vec anchor) {
    if (index >= 0) return index;
    physics::SoftNode node;
    node.offset = toTicks(anchor, 1);
    node.is_pinned = true;
    body.nodes.push_back(node);
    return static_cast<int>(body.nodes.size()) - 1;
  };
  for (const Joint& joint : scene.joints) {
    const int a = nodeOf(joint.a, joint.anchor_a), b = nodeOf(joint.b, joint.anchor_b);
    body.stretches.push_back({a, b, length(joint.anchor_b - joint.anchor_a), kRod / kPerSecondSquared, 0});
  }
  return body;
}

bool canExpress(const Scene& scene) {
  if (scene.field) return false;
  if (scene.beams.size() == 1 && scene.bodies.empty()) return true;
  if (!scene.rigid() || scene.joints.empty()) return false;
  const double drag = scene.bodies[0].linear_drag / scene.bodies[0].mass;
  return std::all_of(scene.bodies.begin(), scene.bodies.end(),
                     [drag](const Body& b) {
                       return b.shapes.empty() && std::abs(b.linear_drag / b.mass - drag) <= 1e-12;
                     }) &&
         std::all_of(scene.joints.begin(), scene.joints.end(),
                     [](const Joint& j) { return j.kind == Joint::Kind::ROD; });
}

physics::SoftBody bodyOf(const Scene& scene) {
  return scene.beams.empty() ? netOf(scene) : beamOf(scene.beams[0]);
}

// Returns the state of the scene's body. Body 0 is a beam's free end.
BodyState stateOf(const physics::SoftBody& body, bool is_beam, int index) {
  const physics::SoftNode& node = is_beam ? body.nodes.back() : body.nodes[at(index)];
  const physics::Vec2 place = (body.place - physics::Place{}) + node.offset;
  return {{place.x, place.y}, {node.velocity.x * kPerSecond, node.velocity.y * kPerSecond}, 0, 0};
}

class Direct : public Simulation {
 public:
  explicit Direct(const Scene& scene) : m_is_beam(!scene.beams.empty()) {
    m_world.setGravity(toTicks(scene.gravity, 1 / kPerSecondSquared));
    m_id = m_world.add(bodyOf(scene));
  }
  void step(double tick, int substeps) override {
    m_world.setSubsteps(substeps);
    m_world.step(tick * kPerSecond);
  }
  BodyState body(int index) const override { return stateOf(m_world.body(m_id), m_is_beam, index); }

 private:
  bool m_is_beam;
  physics::SoftWorld m_world;
  int m_id;
};

class SingleBody : public Simulation {
 public:
  explicit SingleBody(const Scene& scene)
      : m_is_beam(!scene.beams.empty()),
        m_gravity(toTicks(scene.gravity, 1 / kPerSecondSquared)),
        m_body(bodyOf(scene)) {}
  BodyState body(int index) const override { return stateOf(m_body, m_is_beam, index); }

 private:
  const bool m_is_beam;

 protected:
  const physics::Vec2 m_gravity;
  physics::SoftBody m_body;
};

class Euler : public SingleBody {
 public:
  explicit Euler(const Scene& scene) : SingleBody(scene) { m_elastic.prepare(m_body); }
  void step(double tick, int substeps) override {
    const double h = tick * kPerSecond / substeps;
    for (int i = 0; i < substeps; ++i) {
      m_elastic.begin(m_body, h, m_gravity, false);
      for (int k = 0; k < 12; ++k) {
        if (!m_elastic.assemble(m_body, true)) break;
        if (m_elastic.apply(m_body, m_elastic.change()) < 1e-9 * m_body.radius) break;
      }
      m_elastic.finish(m_body);
    }
  }

 private:
  physics::SoftElastic m_elastic;
};

class Projected : public SingleBody {
 public:
  explicit Projected(const Scene& scene) : SingleBody(scene), m_before(m_body.nodes.size()) {}

  void step(double tick, int substeps) override {
    for (int i = 0; i < substeps; ++i) substep(tick * kPerSecond / substeps);
  }

 private:
  void substep(double h) {
    for (std::size_t i = 0; i < m_before.size(); ++i) {
      physics::SoftNode& node = m_body.nodes[i];
      m_before[i] = node.offset;
      if (node.is_pinned) continue;
      node.velocity += h * (m_gravity + node.force / node.mass);
      node.velocity *= 1 / (1 + h * m_body.drag);
      node.offset += h * node.velocity;
    }
    for (const physics::SoftStretch& s : m_body.stretches) {
      const physics::SoftSpan span = physics::spanOf(m_body, s);
      const int nodes[] = {s.a, s.b};
      const physics::Vec2 slopes[] = {-span.direction, span.direction};
      project(nodes, slopes, 2, span.length - s.rest_length, s.stiffness * h * h);
    }
    for (const physics::SoftBend& s : m_body.bends) {
      const physics::SoftCorner corner = physics::cornerOf(m_body, s);
      const int nodes[] = {s.c, s.b, s.a};
      project(nodes, corner.slopes, s.a < 0 ? 2 : 3, corner.bent, s.stiffness * h * h);
    }
    for (std::size_t i = 0; i < m_before.size(); ++i) {
      if (!m_body.nodes[i].is_pinned) m_body.nodes[i].velocity = (m_body.nodes[i].offset - m_before[i]) / h;
    }
  }
  double inverseMass(int node) const {
    return m_body.nodes[at(node)].is_pinned ? 0 : 1 / m_body.nodes[at(node)].mass;
  }
  void project(const int* nodes, const physics::Vec2* slopes, int count, double value, double stiffness) {
    double gives = 1 / stiffness;
    for (int k = 0; k < count; ++k) gives += inverseMass(nodes[k]) * physics::lengthSquared(slopes[k]);
    for (int k = 0; k < count; ++k) {
      m_body.nodes[at(nodes[k])].offset -= inverseMass(nodes[k]) * value / gives * slopes[k];
    }
  }

  std::vector<physics::Vec2> m_before;
};

template <class Kind>
SimulationPtr make(const Scene& scene) {
  return canExpress(scene) ? std::make_unique<Kind>(scene) : nullptr;
}

const RegisteredMethod direct({"soft", "soft, BDF2", "1", Method::Kind::CANDIDATE, make<Direct>});
const RegisteredMethod euler({"soft_euler", "soft, Euler", "1", Method::Kind::CANDIDATE, make<Euler>});
const RegisteredMethod projected({"soft_xpbd", "soft, XPBD", "1", Method::Kind::CANDIDATE, make<Projected>});

}  // namespace
}  // namespace lab
