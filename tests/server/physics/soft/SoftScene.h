// Functions for tests of soft bodies.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "physics/soft/SoftBuild.h"
#include "physics/soft/SoftWorld.h"
#include "tests/server/physics/Shapes.h"

namespace naiad::physics::test {

constexpr double kTicks = 30;                        // per second
constexpr double kGravity = 10 / (kTicks * kTicks);  // 10 cells per second²

constexpr int kBody = 0;  ///< id of the body of worldWith()
inline SoftWorld worldWith(const SoftBody& body, double gravity = 0,
                           int substeps = SoftWorld::kDefaultSubsteps) {
  SoftWorld world;
  EXPECT_TRUE(world.setGravity({0, gravity}) && world.setSubsteps(substeps));
  EXPECT_EQ(world.add(body), kBody);
  return world;
}
inline Vec2 nodeAt(const SoftWorld& world, int id, int node) {
  const SoftBody& body = world.body(id);
  return (body.place - Place{}) + body.nodes[static_cast<std::size_t>(node)].offset;
}
inline Vec2 centreOf(const SoftWorld& world, int id) {
  Vec2 sum;
  double mass = 0;
  for (const SoftNode& node : world.body(id).nodes) sum += node.mass * node.offset, mass += node.mass;
  return (world.body(id).place - Place{}) + sum / mass;
}
inline Vec2 momentumOf(const SoftBody& body) {
  Vec2 sum;
  for (const SoftNode& node : body.nodes) sum += node.mass * node.velocity;
  return sum;
}
inline double fastest(const SoftBody& body) {
  double most = 0;
  for (const SoftNode& node : body.nodes) most = std::max(most, length(node.velocity));
  return most;
}

inline SoftObstacle obstacleAt(int id, const ConvexShape& shape, Vec2 at, double friction = 0) {
  SoftObstacle obstacle;
  obstacle.id = id;
  obstacle.shapes = {&shape, 1};
  obstacle.place = placeAt(at);
  obstacle.friction = friction;
  return obstacle;
}
/// Makes an obstacle of this mass with gravity. `inverse_inertia` is that for a mass of 1.
inline SoftObstacle crateAt(int id, const ConvexShape& shape, Vec2 at, double mass, double inverse_inertia,
                            double friction = 0.5) {
  SoftObstacle crate = obstacleAt(id, shape, at, friction);
  crate.inverse_mass = 1 / mass;
  crate.inverse_inertia = inverse_inertia / mass;
  crate.acceleration = {0, kGravity};
  return crate;
}
/// Moves the obstacle after a step, as the BodyLayer would.
inline void advance(SoftObstacle& o, double dt = 1) {
  o.velocity += dt * o.acceleration + o.inverse_mass * o.impulse;
  o.spin += o.inverse_inertia * o.angular_impulse;
  o.place = o.place + o.displacement;
  o.rotation = turned(o.rotation, o.turn);
}
/// Runs steps in which the obstacle moves.
inline void stepWith(SoftWorld& world, SoftObstacle& moving, int ticks = 1) {
  for (int i = 0; i < ticks; ++i) {
    world.step(1, {&moving, 1});
    advance(moving);
  }
}

}  // namespace naiad::physics::test
