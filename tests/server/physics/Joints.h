// Joints with some settings, for tests.
#pragma once

#include "physics/joint/Joint.h"

namespace naiad::physics::test {

/// Settings of a joint, except its kind, bodies and anchors.
struct JointSettings {
  double length = 0;
  Vec2 axis = {1, 0};
  double stiffness = 0, damping = 0;
  double lower = 0, upper = 0;
  double speed = 0, max_force = kNoLimit;
  Place target = {};
  double break_force = kNoLimit;
};

inline Joint jointOf(JointKind kind, int a, int b, const JointSettings& its = {}, Vec2 on_a = {},
                     Vec2 on_b = {}) {
  Joint joint;
  joint.kind = kind;
  joint.a = a, joint.b = b;
  joint.anchor_a = on_a, joint.anchor_b = on_b;
  joint.length = its.length, joint.axis = its.axis;
  joint.stiffness = its.stiffness, joint.damping = its.damping;
  joint.lower = its.lower, joint.upper = its.upper;
  joint.speed = its.speed, joint.max_force = its.max_force;
  joint.target = its.target, joint.break_force = its.break_force;
  return joint;
}

/// Returns the distance of the joint's anchors.
template <class World>
double gapOf(const World& world, int joint_id) {
  const Joint& joint = world.joint(joint_id);
  const auto &a = world.body(joint.a), &b = world.body(joint.b);
  return length((b.place - a.place) + b.rotation * joint.anchor_b - a.rotation * joint.anchor_a);
}

}  // namespace naiad::physics::test
