// Scenes of rigid bodies: crates of 1 cell, 30 ticks per second, g = 10 cells per second².
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "physics/geometry/Mass.h"
#include "physics/rigid/RigidWorld.h"
#include "tests/server/physics/Joints.h"
#include "tests/server/physics/Shapes.h"

namespace naiad::physics::test {

inline constexpr double kGravityPerTick = 10.0 / 900;

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

/// Makes a body without gravity.
inline RigidBody floating(Vec2 where, const ConvexShape& shape, Vec2 velocity = {}, double mass = 1) {
  RigidBody body = movable(where, shape, mass);
  body.acceleration = {};
  body.velocity = velocity;
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

/// Returns the kinetic energy (speeds in cells per tick).
inline double kineticOf(const RigidBody& body) {
  return (body.inverse_mass > 0 ? 0.5 / body.inverse_mass * lengthSquared(body.velocity) : 0) +
         (body.inverse_inertia > 0 ? 0.5 / body.inverse_inertia * body.spin * body.spin : 0);
}

/// Returns the sum of kinetic and potential energy for a mass of 1.
inline double energyOf(const RigidBody& body) {
  return kineticOf(body) - kGravityPerTick * (body.place - Place{}).y;
}

using Bits = std::array<std::uint64_t, 9>;

inline Bits bitsOf(const RigidBody& body) {
  const auto bits = [](double x) { return std::bit_cast<std::uint64_t>(x); };
  return {static_cast<std::uint64_t>(body.place.cell_x),
          static_cast<std::uint64_t>(body.place.cell_y),
          bits(body.place.dx),
          bits(body.place.dy),
          bits(body.rotation.c),
          bits(body.rotation.s),
          bits(body.velocity.x),
          bits(body.velocity.y),
          bits(body.spin)};
}

inline RigidOptions sleepless() {
  return {.may_sleep = false};
}

/// Makes a world whose body 0 is a floor with its surface at y = 0.
inline RigidWorld onFloor(RigidOptions options = sleepless()) {
  RigidWorld world(options);
  world.add(immovable({0, 5}), boxShape(1000, 5));
  return world;
}

/// Adds a slope through the origin as body 0; it descends to the right by `angle`. Returns its upward normal.
template <class World>
Vec2 addSlope(World& world, double angle) {
  const Rotation turn = rotationBy(angle);
  const Vec2 up = turn * Vec2{0, -1};
  RigidBody slope = immovable(-5.0 * up);
  slope.rotation = turn;
  world.add(slope, boxShape(200, 5));
  return up;
}

/// Adds a crate that lies on the slope whose upward normal is `up`.
template <class World>
int addCrateOnSlope(World& world, double angle, Vec2 up) {
  const ConvexShape crate = boxShape(0.5, 0.25);
  RigidBody body = movable(0.25 * up, crate);
  body.rotation = rotationBy(angle);
  return world.add(body, crate);
}

}  // namespace naiad::physics::test
