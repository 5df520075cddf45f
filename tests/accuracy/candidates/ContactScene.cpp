#include "ContactScene.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "physics/geometry/Index.h"

namespace lab {
namespace {

namespace physics = naiad::physics;
using physics::at;

Vec2 from(Vec v) {
  return {v.x, v.y};
}

auto keyOf(const ContactPair& pair) {
  return std::tuple(pair.a, pair.b, pair.shape_a, pair.shape_b);
}

bool isValid(const Body& body) {
  const double numbers[] = {body.position.x, body.position.y, body.velocity.x, body.velocity.y,
                            body.angle,      body.spin,       body.mass};
  for (const double number : numbers) {
    if (!(std::abs(number) < 1e9)) return false;
  }
  return body.mass > 1e-9 && !body.shapes.empty();
}

class ContactSimulation : public Simulation {
 public:
  ContactSimulation(const Scene& scene, std::unique_ptr<ContactSolver> solver)
      : m_scene(scene), m_solver(std::move(solver)) {}

  void step(double tick, int substeps) override { m_solver->step(m_scene, tick, substeps); }

  BodyState body(int index) const override {
    const ContactBody& body = m_scene.bodies[at(index)];
    return {{body.position.x, body.position.y}, {body.velocity.x, body.velocity.y}, body.angle, body.spin};
  }

 private:
  ContactScene m_scene;
  std::unique_ptr<ContactSolver> m_solver;
};

}  // namespace

ContactScene::ContactScene(const Scene& scene) : gravity(length(scene.gravity)) {
  for (const Body& body : scene.bodies) {
    ContactBody made;
    made.position = from(body.position);
    made.velocity = from(body.velocity);
    made.angle = body.angle;
    made.rotation = physics::rotationBy(body.angle);
    made.spin = body.spin;
    made.friction = body.friction;
    const double inertia = addShapes(body, 1, made.shapes);
    made.turned.resize(made.shapes.size());
    if (body.motion == Motion::FIXED) {
      made.velocity = {};
      made.spin = 0;
    }
    if (body.motion == Motion::DYNAMIC) {
      made.inverse_mass = 1 / body.mass;
      made.inverse_inertia = body.rotates ? 1 / (body.mass * inertia) : 0;
      made.gravity = from(scene.gravity);
      made.drag = body.linear_drag / body.mass;
    }
    bodies.push_back(made);
  }
  m_order.resize(bodies.size());
  std::iota(m_order.begin(), m_order.end(), 0);
}

bool ContactScene::canExpress(const Scene& scene) {
  if (!scene.rigid() || scene.field || !scene.joints.empty() || !scene.collides) return false;
  return std::all_of(scene.bodies.begin(), scene.bodies.end(),
                     [](const Body& body) { return isValid(body) && body.restitution == 0; });
}

void ContactScene::kick(double h) {
  for (ContactBody& body : bodies) {
    if (!body.isPushed()) continue;
    body.velocity = (body.velocity + h * body.gravity) / (1 + h * body.drag);
  }
}

void ContactScene::drift(double h) {
  for (ContactBody& body : bodies) {
    body.position += h * body.velocity;
    body.turnBy(h * body.spin);
  }
}

// Finds pairs by sorting the bodies along x. Their order hardly changes from step to step.
void ContactScene::find(double h, double reach) {
  for (ContactBody& body : bodies) {
    body.lower = {1e300, 1e300};
    body.upper = {-1e300, -1e300};
    double size = 0;
    for (std::size_t i = 0; i < body.shapes.size(); ++i) {
      physics::turn(body.shapes[i], body.rotation, body.turned[i]);
      const physics::Bounds bounds = physics::boundsOf(body.turned[i]);
      body.lower = {std::min(body.lower.x, bounds.lower.x), std::min(body.lower.y, bounds.lower.y)};
      body.upper = {std::max(body.upper.x, bounds.upper.x), std::max(body.upper.y, bounds.upper.y)};
      size = std::max(size, body.shapes[i].reach + body.shapes[i].radius);
    }
    body.room =
        h * (physics::length(body.velocity) + std::abs(body.spin) * size + h * physics::length(body.gravity));
    const Vec2 wide = {reach / 2 + body.room, reach / 2 + body.room};
    body.lower = body.position + body.lower - wide;
    body.upper = body.position + body.upper + wide;
  }
  const auto isBefore = [&](int a, int b) { return bodies[at(a)].lower.x < bodies[at(b)].lower.x; };
  for (std::size_t i = 1; i < m_order.size(); ++i) {
    for (std::size_t k = i; k > 0 && isBefore(m_order[k], m_order[k - 1]); --k) {
      std::swap(m_order[k], m_order[k - 1]);
    }
  }
  m_before.swap(pairs);
  pairs.clear();
  for (std::size_t i = 0; i < m_order.size(); ++i) {
    const ContactBody& body = bodies[at(m_order[i])];
    for (std::size_t k = i + 1; k < m_order.size(); ++k) {
      const ContactBody& other = bodies[at(m_order[k])];
      if (other.lower.x > body.upper.x) break;
      if (other.lower.y > body.upper.y || body.lower.y > other.upper.y) continue;
      if (!body.isPushed() && !other.isPushed()) continue;
      findPair(std::min(m_order[i], m_order[k]), std::max(m_order[i], m_order[k]), reach);
    }
  }
  std::sort(pairs.begin(), pairs.end(),
            [](const ContactPair& a, const ContactPair& b) { return keyOf(a) < keyOf(b); });
}

void ContactScene::findPair(int a, int b, double reach) {
  const ContactBody& first = bodies[at(a)];
  const ContactBody& second = bodies[at(b)];
  const Vec2 offset = second.position - first.position;
  const double far = reach + first.room + second.room;
  for (int i = 0; i < static_cast<int>(first.turned.size()); ++i) {
    for (int k = 0; k < static_cast<int>(second.turned.size()); ++k) {
      ContactPair pair;
      pair.a = a;
      pair.b = b;
      pair.shape_a = i;
      pair.shape_b = k;
      const auto place =
          std::lower_bound(m_before.begin(), m_before.end(), pair,
                           [](const ContactPair& x, const ContactPair& y) { return keyOf(x) < keyOf(y); });
      const ContactPair* p_before =
          place != m_before.end() && keyOf(*place) == keyOf(pair) ? &*place : nullptr;
      physics::Manifold manifold;
      if (!physics::collide(first.turned[at(i)], second.turned[at(k)], offset, far,
                            p_before == nullptr ? physics::ReferenceFace{} : p_before->reference, manifold)) {
        continue;
      }
      pair.normal = manifold.normal;
      pair.reference = manifold.reference;
      pair.friction = std::sqrt(first.friction * second.friction);
      pair.count = manifold.count;
      for (int p = 0; p < pair.count; ++p) {
        const physics::ManifoldPoint& found = manifold.points[at(p)];
        ContactPoint& point = pair.points[at(p)];
        point.id = found.id;
        if (p_before != nullptr) {
          const auto same = std::ranges::find(p_before->used(), found.id, &ContactPoint::id);
          if (same != p_before->used().end()) point = *same;
        }
        point.gap = found.separation;
        // A sticking point keeps its anchors.
        if (!point.sticks) {
          point.anchor_a = physics::inverse(first.rotation) * found.anchor_a;
          point.anchor_b = physics::inverse(second.rotation) * found.anchor_b;
        }
        point.found = {found.anchor_a, found.anchor_b};
        point.normal_mass = massOf(*this, pair, point.found, pair.normal);
        point.tangent_mass = massOf(*this, pair, point.found, physics::perpendicular(pair.normal));
      }
      pairs.push_back(pair);
    }
  }
}

ContactArms armsOf(const ContactScene& scene, const ContactPair& pair, const ContactPoint& point) {
  return {scene.bodies[at(pair.a)].rotation * point.anchor_a,
          scene.bodies[at(pair.b)].rotation * point.anchor_b};
}

double gapOf(const ContactScene& scene, const ContactPair& pair, const ContactPoint& point,
             const ContactArms& arms) {
  const Vec2 between =
      (scene.bodies[at(pair.b)].position + arms.b) - (scene.bodies[at(pair.a)].position + arms.a);
  return dot(between, pair.normal) + point.gap;
}

Vec2 speedOf(const ContactScene& scene, const ContactPair& pair, const ContactArms& arms) {
  const ContactBody& a = scene.bodies[at(pair.a)];
  const ContactBody& b = scene.bodies[at(pair.b)];
  return (b.velocity + cross(b.spin, arms.b)) - (a.velocity + cross(a.spin, arms.a));
}

double massOf(const ContactScene& scene, const ContactPair& pair, const ContactArms& arms, Vec2 direction) {
  const ContactBody& a = scene.bodies[at(pair.a)];
  const ContactBody& b = scene.bodies[at(pair.b)];
  const double turn_a = cross(arms.a, direction), turn_b = cross(arms.b, direction);
  return 1 / (a.inverse_mass + b.inverse_mass + a.inverse_inertia * turn_a * turn_a +
              b.inverse_inertia * turn_b * turn_b);
}

void push(ContactScene& scene, const ContactPair& pair, const ContactArms& arms, Vec2 impulse) {
  ContactBody& a = scene.bodies[at(pair.a)];
  ContactBody& b = scene.bodies[at(pair.b)];
  a.velocity -= a.inverse_mass * impulse;
  a.spin -= a.inverse_inertia * cross(arms.a, impulse);
  b.velocity += b.inverse_mass * impulse;
  b.spin += b.inverse_inertia * cross(arms.b, impulse);
}

void shift(ContactScene& scene, const ContactPair& pair, const ContactArms& arms, Vec2 impulse) {
  ContactBody& a = scene.bodies[at(pair.a)];
  ContactBody& b = scene.bodies[at(pair.b)];
  a.position -= a.inverse_mass * impulse;
  a.turnBy(-a.inverse_inertia * cross(arms.a, impulse));
  b.position += b.inverse_mass * impulse;
  b.turnBy(b.inverse_inertia * cross(arms.b, impulse));
}

double addShapes(const Body& body, double up, std::vector<physics::ConvexShape>& shapes) {
  double inertia = 0;
  for (const Shape& shape : body.shapes) {
    const Vec2 centre{shape.centre.x, up * shape.centre.y};
    physics::ConvexShape& made = shapes.emplace_back();
    if (shape.kind == Shape::Kind::CIRCLE) {
      physics::makeCircle(shape.radius, centre, made);
    } else {
      physics::makeBox(shape.half.x, shape.half.y, centre, {}, 0, made);
    }
    inertia = inertiaOf(shape);
  }
  return inertia;
}

SimulationPtr runContacts(const Scene& scene, std::unique_ptr<ContactSolver> solver) {
  return std::make_unique<ContactSimulation>(scene, std::move(solver));
}

}  // namespace lab
