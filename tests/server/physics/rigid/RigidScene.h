// Scenes of rigid bodies: crates of 1 cell, 30 ticks a second, g = 10 cells/s².
#pragma once

#include <cmath>
#include <numbers>

#include "physics/geometry/Mass.h"
#include "physics/rigid/RigidWorld.h"

namespace naiad::physics::test {

inline constexpr double kGravityPerTick = 10.0 / 900;

inline ConvexShape boxShape(double half_width, double half_height) {
  ConvexShape shape;
  makeBox(half_width, half_height, {}, {}, 0, shape);
  return shape;
}

inline ConvexShape circleShape(double radius) {
  ConvexShape shape;
  makeCircle(radius, {}, shape);
  return shape;
}

inline RigidBody movable(Vec2 where, const ConvexShape& shape, double mass = 1) {
  RigidBody body;
  const Mass of = massOf(shape, 1);
  body.place = placeAt(where);
  body.inverse_mass = 1 / mass;
  body.inverse_inertia = of.mass / (mass * of.inertia);
  body.acceleration = {0, kGravityPerTick};
  body.friction = 0.5;
  return body;
}

inline RigidBody immovable(Vec2 where) {
  RigidBody body;
  body.place = placeAt(where);
  body.inverse_mass = 0;
  body.friction = 0.5;
  return body;
}

inline Vec2 whereIs(const RigidWorld& world, int id) {
  return world.body(id).place - Place{};
}

inline RigidOptions sleepless() {
  RigidOptions options;
  options.may_sleep = false;
  return options;
}

/// A floor whose surface is y = 0, as body 0.
inline RigidWorld onFloor(RigidOptions options = sleepless()) {
  RigidWorld world(options);
  world.add(immovable({0, 5}), boxShape(1000, 5));
  return world;
}

/// A slope that falls to the right by `angle` through the origin, as body 0, and its upward normal.
inline Vec2 addSlope(RigidWorld& world, double angle) {
  const Rotation turn = rotationBy(angle);
  const Vec2 up = turn * Vec2{0, -1};
  RigidBody slope = immovable(-5.0 * up);
  slope.rotation = turn;
  world.add(slope, boxShape(200, 5));
  return up;
}

}  // namespace naiad::physics::test
