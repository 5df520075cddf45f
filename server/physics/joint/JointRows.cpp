#include "physics/joint/JointRows.h"

namespace naiad::physics {

namespace {

// Returns the sine of the angle; beyond a right angle, a function that continues it and grows further.
double bentSine(Rotation r) {
  if (r.c >= 0) return r.s;
  return r.s >= 0 ? 2 - r.s : -2 - r.s;
}

}  // namespace

bool isAngleRow(JointKind kind, int row) {
  return kind == JointKind::kMotor || kind == JointKind::kAngleLimit ||
         (kind == JointKind::kWeld && row == 2) || (kind == JointKind::kSlider && row == 1);
}

void placeRows(const Joint& joint, const JointFrame& frame, SpeedRows& rows) {
  const auto along = [&](Vec2 n, Vec2 lever_a, double value) -> SpeedRow {
    return {n, -cross(lever_a, n), cross(frame.arm_b, n), value, 0};
  };
  const auto angle = [](double value, int side) -> SpeedRow { return {{}, -1, 1, value, side}; };
  switch (joint.kind) {
    case JointKind::kDistance:
    case JointKind::kRope:
    case JointKind::kSpring:
      if (rowsOf(joint) == 1) {
        const double distance = length(frame.offset);
        rows[0] = along(distance > 1e-12 ? frame.offset / distance : Vec2{1, 0}, frame.arm_a,
                        distance - joint.length);
        rows[0].side = joint.kind == JointKind::kRope ? -1 : 0;
        break;
      }
      [[fallthrough]];
    case JointKind::kHinge:
    case JointKind::kWeld:
    case JointKind::kMouse:
      rows[0] = along({1, 0}, frame.arm_a, frame.offset.x);
      rows[1] = along({0, 1}, frame.arm_a, frame.offset.y);
      if (joint.kind == JointKind::kWeld) rows[2] = angle(bentSine(frame.between), 0);
      break;
    case JointKind::kSlider: {
      const Vec2 n = perpendicular(frame.axis);
      rows[0] = along(n, frame.arm_a + frame.offset, dot(n, frame.offset));
      rows[1] = angle(bentSine(frame.between), 0);
      break;
    }
    case JointKind::kMotor:
      rows[0] = angle(0, 0);
      break;
    case JointKind::kAngleLimit: {
      const double now = angleOf(frame.between);
      const bool is_lower = now - joint.lower < joint.upper - now;
      rows[0] = angle(now - (is_lower ? joint.lower : joint.upper), is_lower ? 1 : -1);
      break;
    }
  }
}

}  // namespace naiad::physics
