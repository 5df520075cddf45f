// Fixtures with a world of bodies. One unit is a metre on both axes; times are in seconds.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <utility>
#include <vector>

#include "physics/body/Body.h"
#include "physics/body/BodyLayer.h"
#include "physics/body/EventContactEnd.h"
#include "physics/body/Field.h"
#include "physics/body/PhysicsManager.h"
#include "physics/body/Seconds.h"
#include "tests/server/engine/Probe.h"

namespace df::test {

/// A world with cells twice as high as wide.
class PhysicsWorld : public WorldTest {
 public:
  /// Makes a HARD Object without mass.
  template <class Its = Object>
  static Its* wall(Vector centre, Vector half) {
    auto* p_wall = new Its;
    p_wall->setBox(Box(Vector(-half.x(), -half.y()), 2 * half.x(), 2 * half.y()));
    p_wall->setPosition(centre);
    return p_wall;
  }
  template <class Its = Body>
  static Its* ball(Vector place, Vector velocity, double radius = 0.5) {
    auto* p_ball = new Its;
    p_ball->setCircle(radius);
    p_ball->setPosition(place);
    p_ball->setVelocity(perSecond(velocity));
    p_ball->setRestitution(1);
    p_ball->setFriction(0);
    return p_ball;
  }
  template <class Its = Body>
  static Its* crate(Vector place, Vector half = Vector(0.5, 0.5), double mass = 1) {
    auto* p_crate = new Its;
    p_crate->setBoxShape(2 * half.x(), 2 * half.y());
    p_crate->setPosition(place);
    p_crate->setMass(mass);
    return p_crate;
  }

  template <class Its = Body>
  static Its* turningCrate(Vector place, Vector half = Vector(0.5, 0.5), double mass = 1) {
    Its* p_crate = crate<Its>(place, half, mass);
    p_crate->setTurning();
    return p_crate;
  }
  /// Sets the gravity to 10 units per second² and makes a floor with its surface at y = 0.
  static Object* layFloor(double half_width = 50, double half_height = 5) {
    PM.setGravity(perSecondSquared(Vector(0, 10)));
    return wall(Vector(0, half_height), Vector(half_width, half_height));
  }
};

class BodyScene : public PhysicsWorld {
 protected:
  BodyScene() { PM.setAspect(1); }
  void ticks(int n) {
    for (int i = 0; i < n; ++i) world.update();
  }
  /// Returns the layer, which has the solvers' counters. It exists after the first body was made.
  const naiad::physics::BodyLayer& layer() { return *world.findLayer<naiad::physics::BodyLayer>(); }

 public:
  /// Returns the velocity in units per second.
  static Vector speedOf(const Body* p_body) {
    return Vector(30 * p_body->getVelocity().x(), 30 * p_body->getVelocity().y());
  }
  static double kineticOf(const Body* p_body) {
    const Vector v = p_body->getVelocity();
    const double turning = p_body->getInertia() * p_body->getSpin() * p_body->getSpin();
    return 0.5 * (p_body->getMass() * (v.x() * v.x() + v.y() * v.y()) + (p_body->isTurning() ? turning : 0));
  }
};

/// Position, velocity, angle and spin.
using BodyBits = std::array<std::uint64_t, 6>;
inline BodyBits stateBits(const Body* p_body) {
  const Vector place = p_body->getPosition(), velocity = p_body->getVelocity();
  return std::bit_cast<BodyBits>(
      std::array{place.x(), place.y(), velocity.x(), velocity.y(), p_body->getAngle(), p_body->getSpin()});
}

/// A second world, which is current instead of the test's world while this is in scope.
struct OwnWorld : LoggedWorld {
  explicit OwnWorld(double aspect = 1, Vector gravity = Vector(), Accuracy accuracy = ACCURACY_DEFAULT) {
    PM.setAspect(aspect);
    PM.setGravity(gravity);
    PM.setAccuracy(accuracy);
  }
  /// Runs some ticks, each after a call of `before` with its number. Returns the bodies' states after each.
  std::vector<BodyBits> states(int ticks, const std::vector<Body*>& bodies,
                               const std::function<void(int tick)>& before = {}) {
    std::vector<BodyBits> all;
    for (int tick = 0; tick < ticks; ++tick) {
      if (before) before(tick);
      world.update();
      for (const Body* p_body : bodies) all.push_back(stateBits(p_body));
    }
    return all;
  }
};

/// A Field by a function of displacement and velocity. Counts its calls.
class FieldOf : public Field {
 public:
  using Pull = std::function<Vector(Vector displacement, Vector velocity)>;
  explicit FieldOf(Pull pull) : m_pull(std::move(pull)) {}
  Vector accelerationAt(Vector displacement, Vector velocity, double /*time*/) const override {
    ++calls;
    return m_pull(displacement, velocity);
  }
  mutable std::int64_t calls = 0;

 private:
  Pull m_pull;
};

/// An Object that calls a function with the other Object when a contact begins. The function may delete both.
template <class Base>
class Touchy : public Base {
 public:
  using Base::Base;
  int eventHandler(const Event* p_e) override {
    if (p_e->getType() != COLLISION_EVENT || !on_contact) return 0;
    const auto* p_c = static_cast<const EventCollision*>(p_e);
    const auto handler = on_contact;  // a copy, because the function may delete this
    handler(p_c->getObject1() == this ? p_c->getObject2() : p_c->getObject1());
    return 1;
  }
  std::function<void(Object* p_other)> on_contact;
};

/// An Object that records its contact events.
template <class Base>
class Recording : public Base {
 public:
  using Base::Base;
  struct Note {
    bool is_begin;
    const Object* p_first;
    const Object* p_second;
    double impulse;
  };
  int eventHandler(const Event* p_e) override {
    if (p_e->getType() == COLLISION_EVENT) {
      const auto* p_c = static_cast<const EventCollision*>(p_e);
      notes.push_back({true, p_c->getObject1(), p_c->getObject2(), p_c->getImpulse()});
    } else if (p_e->getType() == CONTACT_END_EVENT) {
      const auto* p_c = static_cast<const EventContactEnd*>(p_e);
      notes.push_back({false, p_c->getObject1(), p_c->getObject2(), 0});
    }
    return 1;
  }
  int begins() const {
    return static_cast<int>(std::count_if(notes.begin(), notes.end(), [](auto& n) { return n.is_begin; }));
  }
  int ends() const { return static_cast<int>(notes.size()) - begins(); }
  /// Returns the other Object of the last event, which must exist.
  const Object* other() const {
    const Note& last = notes.back();
    return last.p_first == this ? last.p_second : last.p_first;
  }
  /// Checks that begin and end events alternate for each pair. Returns which pairs are in contact now.
  std::map<std::pair<const Object*, const Object*>, bool> expectTurns() const {
    std::map<std::pair<const Object*, const Object*>, bool> touches;
    for (const Note& note : notes) {
      bool& is_touching = touches[{note.p_first, note.p_second}];
      EXPECT_NE(is_touching, note.is_begin);
      is_touching = note.is_begin;
    }
    return touches;
  }

  std::vector<Note> notes;
};
using Listener = Recording<Body>;

}  // namespace df::test
