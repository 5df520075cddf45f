// Scenes in a SubstepWorld: crates of 1 cell, 30 ticks per second, g = 10 cells per second².
#pragma once

#include <algorithm>
#include <functional>
#include <limits>
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
  /// Adds a fixed point.
  int addNail(Vec2 where = {}) { return world.addInOrder(++order, immovable(where), {}); }
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
  /// Runs `n` ticks. Returns the largest value of `of` at the end of any of them.
  double most(int n, const std::function<double()>& of) {
    double largest = -std::numeric_limits<double>::infinity();
    for (int i = 0; i < n; ++i) {
      world.step();
      largest = std::max(largest, of());
    }
    return largest;
  }
  /// Returns the largest value of `of` for any of the ids.
  static double largest(const std::vector<int>& ids, const std::function<double(int id)>& of) {
    double most = -std::numeric_limits<double>::infinity();
    for (const int id : ids) most = std::max(most, of(id));
    return most;
  }
  /// Runs `n` ticks. Returns the deepest overlap at the end of any of them.
  double deepest(int n) {
    return most(n, [this] { return world.deepest(); });
  }
  void setVelocity(int id, Vec2 velocity) {
    RigidBody body = world.body(id);
    body.velocity = velocity;
    EXPECT_TRUE(world.set(id, body));
  }
  Vec2 at(int id) const { return world.body(id).place - Place{}; }
  double speed(int id) const { return length(world.body(id).velocity); }
  double gap(int joint_id) const { return gapOf(world, joint_id); }

  SubstepWorld world;
  std::uint64_t order = 0;
};

/// A crate that sleeps on a floor.
struct SleepingCrate : SubstepScene {
  SleepingCrate() {
    addFloor();
    crate = addCrate({0, -0.5});
    ticks(60);
    EXPECT_TRUE(world.isAsleep(crate));
  }
  int crate = -1;
};

inline SubstepOptions awake() {
  return {.may_sleep = false};
}

}  // namespace naiad::physics::test
