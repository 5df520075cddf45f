// Momentum of the groups of a SubstepWorld that nothing holds.
#include <algorithm>
#include <cmath>

#include "physics/substep/SubstepWorld.h"

namespace naiad::physics {

namespace {

// Part by which the rotation of a group may exceed its energy in a step. With a given angular momentum, a
// group that shrinks needs more energy.
constexpr double kShrunk = 1e-4;

}  // namespace

// Computes the momentum that groups lost by rounding, because float impulses are not exactly equal on both
// bodies of a contact, and how far sub-steps deviate from a fall without contacts. finish() corrects both for
// groups that nothing holds.
void SubstepWorld::keepMomentum() {
  findGroups();
  const auto changeOf = [&](const SubstepBody& b) {
    const SubstepState& s = m_states[at(b.state)];
    return m_dt * b.body.acceleration - Vec2{s.vx, s.vy};
  };
  for (const std::int32_t id : m_active) {
    SubstepBody& b = m_bodies[at(id)];
    Group& group = groupOf(b);
    if (group.is_held || !isMovable(b) || b.body.inverse_mass == 0) continue;
    if (m_energy.isSlowed(b.state)) b.pushed_at = m_steps;  // else only its flight would move it
    const double mass = 1 / b.body.inverse_mass;
    group.missing += mass * changeOf(b);
    const SubstepState& s = m_states[at(b.state)];
    group.missing_path += mass * ((0.5 * m_dt * m_dt) * b.body.acceleration - Vec2{s.x, s.y});
    group.mass += mass;
    ++group.members;
    group.is_diverted = group.is_diverted || b.part < 1 || b.is_diverted;
  }
  for (const Magnet& magnet : m_magnets) {  // the momentum that a magnet added was not lost
    const SubstepBody& b = m_bodies[at(magnet.id)];
    Group& group = groupOf(b);
    group.is_diverted = true;
    if (!group.is_held) group.missing += magnet.given / b.body.inverse_mass;
  }
  listFree();
}

void SubstepWorld::Sums::add(const RigidBody& body, const Free& group) {
  const double m = 1 / body.inverse_mass, inertia_of_body = 1 / body.inverse_inertia;
  const Vec2 from = body.place - group.origin, speed = body.velocity - group.velocity;
  mass += m;
  path += m * from;
  momentum += m * speed;
  angular += m * cross(from, speed) + inertia_of_body * body.spin;
  inertia += m * lengthSquared(from) + inertia_of_body;
  twice_energy += m * lengthSquared(speed) + inertia_of_body * body.spin * body.spin;
}

// Lists the groups of several bodies that nothing holds, with their angular momentum before the step. Leaves
// out groups in which forces differ or a body does not turn, because their angular momentum changes.
void SubstepWorld::listFree() {
  m_free_groups.clear();
  m_free_members.clear();
  for (const std::int32_t id : m_active) {
    const RigidBody& body = m_bodies[at(id)].body;
    Group& group = groupOf(m_bodies[at(id)]);
    if (group.is_held || group.members < 2 || !isMovable(body)) continue;
    if (group.free < 0) {
      group.free = static_cast<std::int32_t>(m_free_groups.size());
      m_free_groups.push_back({body.place, body.velocity, body.acceleration, body.jerk});
    }
    Free& free = m_free_groups[at(group.free)];
    free.is_kept = free.is_kept && body.inverse_mass > 0 && body.inverse_inertia > 0 && body.turn_rate == 0 &&
                   body.acceleration == free.acceleration && body.jerk == free.jerk;
    if (!free.is_kept) continue;
    free.before.add(body, free);
    free.torque += body.torque;
    m_free_members.emplace_back(id, group.free);
  }
}

// Corrects the angular momentum of these groups by one rotation of the group. Impulses act at the points
// that were found before the step, and bodies have moved on when they act. The energy that the correction
// would add is taken from the motion of the bodies relative to that rotation. If that is too little, less is
// corrected.
void SubstepWorld::keepAngularMomentum() {
  for (const auto& [id, number] : m_free_members) {
    Free& free = m_free_groups[at(number)];
    free.is_kept = free.is_kept && !m_bodies[at(id)].is_frozen;
    if (free.is_kept) free.after.add(m_bodies[at(id)].body, free);
  }
  for (const auto& [id, number] : m_free_members) {
    const Free& free = m_free_groups[at(number)];
    if (!free.is_kept) continue;
    RigidBody& body = m_bodies[at(id)].body;
    const Sums& now = free.after;
    const double inertia = now.inertiaAboutMiddle(), energy = now.twiceEnergyAboutMiddle();
    const double most = (1 + kShrunk) * std::sqrt(std::max(inertia * energy, 0.0));
    const double found = now.angularAboutMiddle();
    const double kept = std::clamp(free.before.angularAboutMiddle() + m_dt * free.torque, -most, most);
    const double rotation = found / inertia, missing = (kept - found) / inertia;
    const double inner = energy - found * rotation, surplus = missing * (kept + found);
    const double slowed = surplus > 0 && inner > 0 ? 1 - std::sqrt(std::max(1 - surplus / inner, 0.0)) : 0;
    const Vec2 from = body.place - free.origin - now.path / now.mass;
    const Vec2 speed = body.velocity - free.velocity - now.momentum / now.mass - cross(rotation, from);
    body.velocity += cross(missing, from) - slowed * speed;
    body.spin += missing - slowed * (body.spin - rotation);
  }
}

}  // namespace naiad::physics
