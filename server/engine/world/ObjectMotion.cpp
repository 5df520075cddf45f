// The part of Object that moves: position, velocity, acceleration.

#include <bit>
#include <cmath>
#include <cstdint>

#include "engine/world/Object.h"
#include "engine/world/World.h"
#include "engine/world/WorldStore.h"

namespace df {

namespace {

bool sameBits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

bool isFiniteFloat(double x) {
  return std::isfinite(static_cast<float>(x));
}

}  // namespace

int Object::setPosition(Vector new_pos) {
  const auto position = toFixed(new_pos);
  if (!position) return refuse("setPosition");
  m_p_store->setPosition(m_slot, *position);
  return 0;
}

Vector Object::getPosition() const {
  return Vector::fromFixed(m_p_store->position(m_slot));
}

void Object::deriveKinematics() const {
  ObjectProfile& profile = *m_p_profile;
  const bool follow = m_p_store->has(m_slot, WorldStore::kDerive);
  if (!follow && !profile.direction_is_velocity) return;
  if (follow) profile.direction = getVelocity();
  m_p_store->setDerived(m_slot, false);
  profile.direction_is_velocity = false;
  profile.speed = std::sqrt(profile.direction.x() * profile.direction.x() +
                            profile.direction.y() * profile.direction.y());
  profile.direction.normalize();
}

int Object::applyVelocity(double speed, Vector direction) {
  if (!isFiniteFloat(speed) || !isFiniteFloat(direction.x()) || !isFiniteFloat(direction.y())) return -1;
  const auto velocity = toFixed(Vector(direction.x() * speed, direction.y() * speed), kMaxVelocityCells);
  if (!velocity) return -1;
  m_p_profile->speed = speed;
  m_p_profile->direction = direction;
  m_p_profile->direction_is_velocity = false;
  m_p_store->setVelocity(m_slot, *velocity);
  return 0;
}

int Object::setSpeed(double speed) {
  deriveKinematics();
  return applyVelocity(speed, m_p_profile->direction) == 0 ? 0 : refuse("setSpeed");
}

float Object::getSpeed() const {
  deriveKinematics();
  return static_cast<float>(m_p_profile->speed);
}

int Object::setDirection(Vector new_direction) {
  deriveKinematics();
  return applyVelocity(m_p_profile->speed, new_direction) == 0 ? 0 : refuse("setDirection");
}

Vector Object::getDirection() const {
  deriveKinematics();
  return m_p_profile->direction;
}

// The product of length and normalised vector is the vector itself, so it is rounded as it is: that way
// what was set is what getVelocity() returns, at any size.
int Object::setVelocity(Vector new_velocity) {
  const auto velocity = toFixed(new_velocity, kMaxVelocityCells);
  if (!velocity) return refuse("setVelocity");
  // Speed and direction are derived from the velocity where it has them to the last bit (it has no -0).
  const Vector derived = Vector::fromFixed(*velocity);
  const bool is_derived = sameBits(derived.x(), new_velocity.x()) && sameBits(derived.y(), new_velocity.y());
  m_p_store->setDerived(m_slot, is_derived);
  if (!is_derived) {
    m_p_profile->direction = new_velocity;
    m_p_profile->direction_is_velocity = true;
  }
  m_p_store->setVelocity(m_slot, *velocity);
  return 0;
}

Vector Object::getVelocity() const {
  return Vector::fromFixed(m_p_store->velocity(m_slot));
}

int Object::setAcceleration(Vector new_acceleration) {
  const auto acceleration = toFixed(new_acceleration, kMaxVelocityCells);
  if (!acceleration) return refuse("setAcceleration");
  m_p_store->setAcceleration(m_slot, *acceleration);
  return 0;
}

Vector Object::getAcceleration() const {
  return Vector::fromFixed(m_p_store->acceleration(m_slot));
}

Vector Object::predictPosition() const {
  return Vector::fromFixed(m_p_store->position(m_slot) + m_p_store->velocity(m_slot));
}

}  // namespace df
