#include "physics/body/BodyJoint.h"

#include <cmath>
#include <numbers>

#include "physics/body/BodyLimits.h"
#include "physics/body/BodyTable.h"
#include "shared/values/Fixed.h"

namespace df {

namespace {

using naiad::physics::JointEntry;
using naiad::physics::JointKind;

bool isOneOf(JointKind kind, JointKind first, JointKind second, JointKind third) {
  return kind == first || kind == second || kind == third;
}

}  // namespace

JointEntry* Joint::find() const {
  return m_table != nullptr ? m_table->joints.find(m_key) : nullptr;
}

bool Joint::exists() const {
  return find() != nullptr;
}

int Joint::remove() {
  if (find() == nullptr) return -1;
  m_table->joints.remove(m_key);
  return 0;
}

int Joint::setBreakForce(double force) {
  JointEntry* p_entry = find();
  if (p_entry == nullptr || !(force >= 0)) return -1;
  p_entry->joint.break_force = force;
  ++p_entry->tunings;
  return 0;
}

int Joint::setBreakTorque(double torque) {
  JointEntry* p_entry = find();
  if (p_entry == nullptr || !(torque >= 0)) return -1;
  p_entry->joint.break_torque = torque;
  ++p_entry->tunings;
  return 0;
}

int Joint::setLength(double length) {
  JointEntry* p_entry = find();
  if (p_entry == nullptr || !isUsableSize(length)) return -1;
  const JointKind kind = p_entry->joint.kind;
  if (!isOneOf(kind, JointKind::kDistance, JointKind::kRope, JointKind::kSpring)) return -1;
  if (length == 0 && kind != JointKind::kSpring) return -1;
  p_entry->joint.length = length;
  ++p_entry->tunings;
  m_table->joints.markChanged();  // a spring of length 0 has one row more
  return 0;
}

double Joint::getLength() const {
  const JointEntry* p_entry = find();
  return p_entry != nullptr ? p_entry->joint.length : 0;
}

int Joint::setStiffness(double stiffness, double damping) {
  JointEntry* p_entry = find();
  if (p_entry == nullptr || !isUsableSize(stiffness) || !isUsableSize(damping)) return -1;
  const JointKind kind = p_entry->joint.kind;
  if (kind != JointKind::kSpring && kind != JointKind::kMouse) return -1;
  p_entry->joint.stiffness = stiffness;
  p_entry->joint.damping = damping;
  ++p_entry->tunings;
  return 0;
}

int Joint::setSpeed(double speed) {
  JointEntry* p_entry = find();
  if (p_entry == nullptr || p_entry->joint.kind != JointKind::kMotor || !isUsable(speed)) return -1;
  p_entry->joint.speed = speed;
  ++p_entry->tunings;
  return 0;
}

int Joint::setStrength(double strength) {
  JointEntry* p_entry = find();
  if (p_entry == nullptr || !(strength >= 0)) return -1;
  const JointKind kind = p_entry->joint.kind;
  if (kind != JointKind::kMotor && kind != JointKind::kMouse) return -1;
  p_entry->joint.max_force = strength;
  ++p_entry->tunings;
  m_table->joints.markChanged();  // a mouse without a bound needs no search of an active set
  return 0;
}

int Joint::setLimits(double lower, double upper) {
  JointEntry* p_entry = find();
  const bool good = lower <= upper && lower > -std::numbers::pi && upper < std::numbers::pi;
  if (p_entry == nullptr || p_entry->joint.kind != JointKind::kAngleLimit || !good) return -1;
  p_entry->joint.lower = lower;
  p_entry->joint.upper = upper;
  ++p_entry->tunings;
  return 0;
}

int Joint::setTarget(Vector target) {
  JointEntry* p_entry = find();
  if (p_entry == nullptr || p_entry->joint.kind != JointKind::kMouse) return -1;
  if (!toFixed(target)) return -1;
  p_entry->joint.target = m_table->metric.placeAtCells(target);
  ++p_entry->tunings;
  return 0;
}

Vector Joint::getForce() const {
  const JointEntry* p_entry = find();
  return p_entry != nullptr ? m_table->metric.toCells(p_entry->joint.force) : Vector();
}

double Joint::getTorque() const {
  const JointEntry* p_entry = find();
  return p_entry != nullptr ? p_entry->joint.torque : 0;
}

}  // namespace df
