#include "physics/body/BodyJoint.h"

#include <algorithm>
#include <numbers>

#include "physics/body/BodyLimits.h"
#include "physics/body/BodyTable.h"
#include "shared/values/Fixed.h"

namespace df {

namespace {

using naiad::physics::JointEntry;
using naiad::physics::JointKind;
using RawJoint = naiad::physics::Joint;

// Changes a value of a joint. Returns −1 if the value is invalid, there is no joint, or it is of a kind that
// is not in `kinds` (if that is empty, any kind is valid).
template <class Change>
int tune(JointEntry* p_entry, std::initializer_list<JointKind> kinds, bool is_good, Change change) {
  if (p_entry == nullptr || !is_good) return -1;
  const bool is_one = std::find(kinds.begin(), kinds.end(), p_entry->joint.kind) != kinds.end();
  if (kinds.size() > 0 && !is_one) return -1;
  change(p_entry->joint);
  ++p_entry->tunings;
  return 0;
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
  return tune(find(), {}, force >= 0, [&](RawJoint& joint) { joint.break_force = force; });
}

int Joint::setBreakTorque(double torque) {
  return tune(find(), {}, torque >= 0, [&](RawJoint& joint) { joint.break_torque = torque; });
}

int Joint::setLength(double length) {
  const auto change = [&](RawJoint& joint) {
    joint.length = length;
    m_table->joints.markChanged();  // because a spring of length 0 has one more row
  };
  if (length == 0) return tune(find(), {JointKind::kSpring}, true, change);
  return tune(find(), {JointKind::kDistance, JointKind::kRope, JointKind::kSpring}, isUsableSize(length),
              change);
}

double Joint::getLength() const {
  const JointEntry* p_entry = find();
  return p_entry != nullptr ? p_entry->joint.length : 0;
}

int Joint::setStiffness(double stiffness, double damping) {
  return tune(find(), {JointKind::kSpring, JointKind::kMouse},
              isUsableSize(stiffness) && isUsableSize(damping), [&](RawJoint& joint) {
                joint.stiffness = stiffness;
                joint.damping = damping;
              });
}

int Joint::setSpeed(double speed) {
  return tune(find(), {JointKind::kMotor}, isUsable(speed), [&](RawJoint& joint) { joint.speed = speed; });
}

int Joint::setStrength(double strength) {
  return tune(find(), {JointKind::kMotor, JointKind::kMouse}, strength >= 0, [&](RawJoint& joint) {
    joint.max_force = strength;
    m_table->joints.markChanged();  // a mouse without force limit needs no search for an active set
  });
}

int Joint::setLimits(double lower, double upper) {
  const bool is_good = lower <= upper && lower > -std::numbers::pi && upper < std::numbers::pi;
  return tune(find(), {JointKind::kAngleLimit}, is_good, [&](RawJoint& joint) {
    joint.lower = lower;
    joint.upper = upper;
  });
}

int Joint::setTarget(Vector target) {
  return tune(find(), {JointKind::kMouse}, toFixed(target).has_value(),
              [&](RawJoint& joint) { joint.target = m_table->metric.placeAtCells(target); });
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
