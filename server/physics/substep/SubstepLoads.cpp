// Contacts of SubstepJoints that press a jointed body with a much larger mass: rows of the joints' systems.
#include <algorithm>

#include "physics/substep/SubstepJoints.h"

namespace naiad::physics {

namespace {

constexpr float kHeavy = 30;      // ratio of masses above which sweeps would sink too deep
constexpr int kMostLoads = 64;    // limit of the loads between movable bodies, which fill the matrix
constexpr float kUnjointed = -1;  // instead of an inverse mass

}  // namespace

// Finds the least inverse mass of the bodies that joints connect.
void SubstepJoints::weigh(std::span<const SubstepBody> bodies) {
  m_pairs_loaded = 0;
  m_sets.reset(bodies.size());
  for (const Shape& shape : m_shapes) {
    if (shape.moves_a && shape.moves_b) m_sets.unite(shape.a, shape.b);
  }
  m_behind.assign(bodies.size(), kUnjointed);
  const auto weighBody = [&](int id) {
    float& least = m_behind[at(m_sets.rootOf(id))];
    const float own = bodies[at(id)].inverse_mass;
    least = least == kUnjointed ? own : std::min(least, own);
  };
  for (const Shape& shape : m_shapes) {
    if (shape.moves_a) weighBody(shape.a);
    if (shape.moves_b) weighBody(shape.b);
  }
}

int SubstepJoints::addLoad(std::span<const SubstepBody> bodies, int a, int b, const Manifold& manifold,
                           double max_push) {
  const SubstepBody &one = bodies[at(a)], &other = bodies[at(b)];
  const bool moves_a = isMovable(one), moves_b = isMovable(other);
  const auto isLoaded = [&](int id, const SubstepBody& by) {
    if (!isMovable(bodies[at(id)])) return false;
    float& behind = m_behind[at(m_sets.rootOf(id))];
    if (behind == kUnjointed) return false;
    if (isMovable(by))
      behind = std::min(behind, by.inverse_mass);  // it presses other contacts of the set, too
    return kHeavy * (isMovable(by) ? by.inverse_mass : behind) < bodies[at(id)].inverse_mass;
  };
  const bool is_on_a = isLoaded(a, other), is_on_b = isLoaded(b, one);
  if (!is_on_a && !is_on_b) return -1;
  if (moves_a && moves_b && ++m_pairs_loaded > kMostLoads) return -1;
  m_loads.push_back(
      {a, b, one.state, other.state, manifold, other.body.velocity - one.body.velocity, max_push});
  m_shapes.push_back({-1, a, b, moves_a, moves_b, manifold.count});
  return static_cast<int>(m_loads.size()) - 1;
}

// Sets the rows of a load; levers and normal are those of the start of the step, as in ContactRows.
void SubstepJoints::placeLoad(const Load& load, const SubstepState& a, const SubstepState& b,
                              float time) const {
  if (load.p_system == nullptr) return;
  const Vec2 n = load.manifold.normal;
  const Vec2 moved = double{time} * load.velocity + Vec2{double{b.x} - a.x, double{b.y} - a.y};
  for (int k = 0; k < load.manifold.count; ++k) {
    const ManifoldPoint& point = load.manifold.points[at(k)];
    const Vec2 turned = (Rotation{b.c, b.s} * point.anchor_b - point.anchor_b) -
                        (Rotation{a.c, a.s} * point.anchor_a - point.anchor_a);
    const double gap = point.separation + dot(n, moved + turned);
    SubstepSystem::Row& row = load.p_system->row(load.row + k);
    row.is_limit = gap > 0;
    row.bias = row.is_limit ? gap / m_h : std::max(m_softness.rate * gap, -load.max_push);
    if (time > 0) continue;
    row.speed = dot(n, load.velocity);
    row.target = 0;
    row.low = 0;
    load.p_system->place(load.row + k, n, -cross(point.anchor_a, n), cross(point.anchor_b, n));
  }
}

// Sets the impulses of loads to those in the rows, which warm starting has applied.
void SubstepJoints::takeLoads(const ContactRows& rows) {
  for (const Load& load : m_loads) {
    for (int k = 0; load.p_system != nullptr && k < load.manifold.count; ++k)
      load.p_system->row(load.row + k).impulse = rows.normalImpulse(load.place, k);
  }
}

// Sets the impulses in the rows, which limit friction.
void SubstepJoints::giveLoads(ContactRows& rows) const {
  for (const Load& load : m_loads) {
    for (int k = 0; load.p_system != nullptr && k < load.manifold.count; ++k)
      rows.setNormalImpulse(load.place, k, static_cast<float>(load.p_system->row(load.row + k).impulse));
  }
}

void SubstepJoints::bounce(std::span<SubstepState> states, ContactRows& rows) {
  bool is_any = false;
  for (const Load& load : m_loads) {
    for (int k = 0; load.p_system != nullptr && k < load.manifold.count; ++k) {
      SubstepSystem::Row& row = load.p_system->row(load.row + k);
      row.target = rows.bounceSpeed(load.place, k);
      row.is_limit = row.is_limit && row.target == 0;
      is_any = is_any || row.target > 0;
    }
  }
  if (!is_any) return;
  for (auto& [first, system] : m_systems) system.rows.solve(states, false);
  giveLoads(rows);
}

}  // namespace naiad::physics
