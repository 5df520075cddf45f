// Scenes in a SubstepWorld: crates of 1 cell, 30 ticks per second, g = 10 cells per second².
#pragma once

#include <span>
#include <vector>

#include "physics/substep/SubstepWorld.h"
#include "tests/server/physics/rigid/RigidScene.h"

namespace naiad::physics::test {

/// A world that gives its bodies consecutive orders.
struct SubstepScene {
  explicit SubstepScene(SubstepOptions options = {}) : world(options) {}

  int add(const RigidBody& body, const ConvexShape& shape) {
    return world.addInOrder(++order, body, std::span(&shape, 1));
  }
  /// Adds a floor with its surface at y = 0.
  int addFloor() { return add(immovable({0, 5}), boxShape(1000, 5)); }
  int addCrate(Vec2 where, double half = 0.5) {
    const ConvexShape shape = boxShape(half, half);
    return add(movable(where, shape), shape);
  }
  int join(const JointSettings& its, JointKind kind, int a, int b, Vec2 on_a = {}, Vec2 on_b = {},
           bool may_touch = false) {
    return world.addJoint(jointOf(kind, a, b, its, on_a, on_b), may_touch);
  }
  void ticks(int n) {
    for (int i = 0; i < n; ++i) world.step();
  }
  Vec2 at(int id) const { return world.body(id).place - Place{}; }
  double speed(int id) const { return length(world.body(id).velocity); }
  /// Returns the distance of the joint's anchors.
  double gap(int joint_id) const {
    const Joint& joint = world.joint(joint_id);
    const RigidBody &a = world.body(joint.a), &b = world.body(joint.b);
    return length((b.place - a.place) + b.rotation * joint.anchor_b - a.rotation * joint.anchor_a);
  }

  SubstepWorld world;
  std::uint64_t order = 0;
};

inline SubstepOptions awake() {
  return {.may_sleep = false};
}

}  // namespace naiad::physics::test
