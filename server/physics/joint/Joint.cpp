#include "physics/joint/Joint.h"

#include <cmath>
#include <numbers>

namespace naiad::physics {

namespace {

constexpr double kLargest = 1e30;  // limit of all numbers: products of two or three of them are finite

bool isUsable(double x) {
  return std::abs(x) <= kLargest;  // false for a NaN
}

bool isUsable(Vec2 a) {
  return isUsable(a.x) && isUsable(a.y);
}

bool isUnit(double square) {
  return std::abs(square - 1) <= 1e-6;
}

bool isUnit(Rotation r) {
  return isUnit(r.c * r.c + r.s * r.s);
}

}  // namespace

bool isValid(const Joint& joint, int body_count) {
  const bool is_mouse = joint.kind == JointKind::kMouse;
  if (joint.b < 0 || joint.b >= body_count) return false;
  if (!is_mouse && (joint.a < 0 || joint.a >= body_count || joint.a == joint.b)) return false;
  if (!isUsable(joint.anchor_a) || !isUsable(joint.anchor_b) || !isUsable(joint.length)) return false;
  if (!isUsable(joint.stiffness) || !isUsable(joint.damping) || !isUsable(joint.speed)) return false;
  if (joint.stiffness < 0 || joint.damping < 0) return false;
  if (!(joint.max_force >= 0) || !(joint.break_force >= 0) || !(joint.break_torque >= 0)) return false;
  if (!isUnit(joint.reference)) return false;
  switch (joint.kind) {
    case JointKind::kDistance:
    case JointKind::kRope:
      return joint.length > 0;
    case JointKind::kSpring:
      return joint.length >= 0;
    case JointKind::kSlider:
      return isUnit(lengthSquared(joint.axis));
    case JointKind::kAngleLimit:
      return joint.lower <= joint.upper && joint.lower > -std::numbers::pi && joint.upper < std::numbers::pi;
    default:
      return true;
  }
}

int rowsOf(const Joint& joint) {
  switch (joint.kind) {
    case JointKind::kHinge:
    case JointKind::kSlider:
    case JointKind::kMouse:
      return 2;
    case JointKind::kWeld:
      return 3;
    case JointKind::kSpring:
      return joint.length > 0 ? 1 : 2;
    default:
      return 1;
  }
}

}  // namespace naiad::physics
