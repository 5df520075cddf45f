#include "physics/joint/JointMotion.h"

#include <algorithm>
#include <cstddef>

#include "physics/geometry/Index.h"

namespace naiad::physics {

JointMotion::JointMotion(std::span<const int> bodies, std::span<const JointBody> all_bodies)
    : body(bodies.begin(), bodies.end()) {
  for (const int index : bodies) {
    mass.push_back({all_bodies[at(index)].inverse_mass, all_bodies[at(index)].inverse_inertia});
  }
  const std::size_t count = body.size();
  place.resize(count);
  velocity.resize(count);
  acceleration.resize(count);
  rotation.resize(count);
  spin.resize(count);
  turn_acceleration.resize(count);
  m_place_before = m_velocity_before = m_kicked = velocity;
  m_rotation_before = rotation;
  m_spin_before = m_spin_kicked = spin;
}

bool JointMotion::load(std::span<const JointBody> all_bodies, Vec2 gravity) {
  const Place& first = all_bodies[at(body[0])].place;
  origin = {first.cell_x, first.cell_y, 0, 0};
  is_turning = false;
  extent = 1;
  bool is_good = isBelow(gravity, kMaxJointMotion);
  for (std::size_t i = 0; i < body.size(); ++i) {
    const JointBody& its = all_bodies[at(body[i])];
    place[i] = its.place - origin;
    velocity[i] = its.velocity;
    rotation[i] = its.rotation;
    spin[i] = its.spin;
    acceleration[i] = accelerationOf(its, gravity);
    turn_acceleration[i] = its.inverse_inertia * its.torque;
    is_turning |= its.inverse_inertia > 0 || its.spin != 0;
    extent = std::max({extent, std::abs(place[i].x), std::abs(place[i].y)});
    is_good = is_good && isBelow(place[i], kMaxJointMotion) && isBelow(velocity[i], kMaxJointMotion) &&
              isBelow(acceleration[i], kMaxJointMotion) &&
              isBelow({its.spin, turn_acceleration[i]}, kMaxJointMotion) &&
              isBelow({its.rotation.c, its.rotation.s}, 2);
  }
  return is_good;
}

bool JointMotion::store(std::span<JointBody> all_bodies) const {
  for (std::size_t i = 0; i < body.size(); ++i) {
    const bool is_good = isBelow(place[i], kMaxJointMotion) && isBelow(velocity[i], kMaxJointMotion) &&
                         std::abs(spin[i]) <= kMaxJointMotion && isBelow({rotation[i].c, rotation[i].s}, 2);
    if (!is_good) return false;
  }
  for (std::size_t i = 0; i < body.size(); ++i) {
    JointBody& its = all_bodies[at(body[i])];
    if (!isMovable(its)) continue;
    its.place = origin + place[i];
    its.velocity = velocity[i];
    its.spin = spin[i];
    if (is_turning) its.rotation = renormalised(rotation[i]);
  }
  return true;
}

void JointMotion::storeVelocities(std::span<JointBody> all_bodies) const {
  for (std::size_t i = 0; i < body.size(); ++i) {
    JointBody& its = all_bodies[at(body[i])];
    if (!isMovable(its)) continue;
    its.velocity = velocity[i];
    its.spin = spin[i];
  }
}

void JointMotion::halt(std::span<JointBody> all_bodies) const {
  for (const int index : body) {
    JointBody& its = all_bodies[at(index)];
    if (!isMovable(its)) continue;
    its.velocity = {};
    its.spin = 0;
  }
}

void JointMotion::save() {
  m_place_before = place;
  m_velocity_before = velocity;
  if (is_turning) {
    m_rotation_before = rotation;
    m_spin_before = spin;
  }
}

void JointMotion::restore() {
  place = m_place_before;
  restoreVelocities();
  if (is_turning) rotation = m_rotation_before;
}

void JointMotion::restoreVelocities() {
  velocity = m_velocity_before;
  if (is_turning) spin = m_spin_before;
}

void JointMotion::saveKicked() {
  m_kicked = velocity;
  m_spin_kicked = spin;
}

void JointMotion::restoreKicked() {
  velocity = m_kicked;
  spin = m_spin_kicked;
}

void JointMotion::kick(double h) {
  for (std::size_t i = 0; i < velocity.size(); ++i) velocity[i] += h * acceleration[i];
  if (!is_turning) return;
  for (std::size_t i = 0; i < spin.size(); ++i) spin[i] += h * turn_acceleration[i];
}

void JointMotion::move(double h) {
  for (std::size_t i = 0; i < place.size(); ++i) place[i] = m_place_before[i] + h * velocity[i];
  if (!is_turning) return;
  for (std::size_t i = 0; i < spin.size(); ++i) {
    if (spin[i] != 0) rotation[i] = turned(m_rotation_before[i], h * spin[i]);
  }
}

void JointMotion::applyImpulses(std::span<const JointRow> rows, const double* impulse, bool is_rods) {
  if (!is_turning && is_rods) {
    for (const JointRow& row : rows) {
      const Vec2 push = *impulse++ * row.n;
      velocity[at(row.b)] += mass[at(row.b)].inverse_mass * push;
      velocity[at(row.a)] -= mass[at(row.a)].inverse_mass * push;
    }
    return;
  }
  for (const JointRow& row : rows) {
    const double s = *impulse++;
    const JointMass& b = mass[at(row.b)];
    velocity[at(row.b)] += (b.inverse_mass * s) * row.n;
    if (is_turning) spin[at(row.b)] += b.inverse_inertia * s * row.jb;
    if (row.a < 0) continue;
    const JointMass& a = mass[at(row.a)];
    velocity[at(row.a)] -= (a.inverse_mass * s) * row.n;
    if (is_turning) spin[at(row.a)] += a.inverse_inertia * s * row.ja;
  }
}

double JointMotion::speedAlong(const JointRow& row) const {
  double speed = dot(row.n, velocity[at(row.b)]) + row.jb * spin[at(row.b)];
  if (row.a >= 0) speed += row.ja * spin[at(row.a)] - dot(row.n, velocity[at(row.a)]);
  return speed;
}

void JointMotion::slowLightBodies() {
  double least = kNoLimit, most = 0;
  for (std::size_t i = 0; i < mass.size(); ++i) {
    if (!(mass[i].inverse_mass > 0) || mass[i].inverse_mass >= least) continue;
    least = mass[i].inverse_mass;
    most = length(velocity[i]);
  }
  for (std::size_t i = 0; i < mass.size(); ++i) {
    const double speed = length(velocity[i]);
    if (mass[i].inverse_mass > 0 && speed > most) velocity[i] *= most / speed;
    if (mass[i].inverse_inertia > 0) spin[i] = 0;
  }
}

void JointMotion::stopAll() {
  for (std::size_t i = 0; i < mass.size(); ++i) {
    if (mass[i].inverse_mass > 0) velocity[i] = {};
    if (mass[i].inverse_inertia > 0) spin[i] = 0;
  }
}

void JointMotion::scaleVelocities(double factor) {
  for (std::size_t i = 0; i < mass.size(); ++i) {
    if (mass[i].inverse_mass > 0) velocity[i] *= factor;
    if (mass[i].inverse_inertia > 0) spin[i] *= factor;
  }
}

double JointMotion::kineticEnergy() const {
  double sum = 0;
  for (std::size_t i = 0; i < mass.size(); ++i) {
    if (mass[i].inverse_mass > 0) sum += 0.5 * lengthSquared(velocity[i]) / mass[i].inverse_mass;
    if (mass[i].inverse_inertia > 0) sum += 0.5 * spin[i] * spin[i] / mass[i].inverse_inertia;
  }
  return sum;
}

double JointMotion::workSinceSave() const {
  double work = 0;
  for (std::size_t i = 0; i < mass.size(); ++i) {
    if (mass[i].inverse_mass > 0)
      work += dot(acceleration[i], place[i] - m_place_before[i]) / mass[i].inverse_mass;
  }
  return work;
}

}  // namespace naiad::physics
