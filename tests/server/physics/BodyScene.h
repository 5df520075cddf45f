// A world of bodies to try things in: a unit is a metre both ways, and times are in seconds.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "engine/managers/WorldManager.h"
#include "engine/world/EventCollision.h"
#include "engine/world/World.h"
#include "engine/world/WorldLog.h"
#include "physics/body/Body.h"
#include "physics/body/EventContactEnd.h"
#include "physics/body/PhysicsManager.h"
#include "physics/body/Seconds.h"

namespace df::test {

class BodyScene : public testing::Test {
 protected:
  BodyScene() : scope(world) {
    world.log().setSink([this](const std::string& line) { log.push_back(line); });
    PM.setAspect(1);
  }
  ~BodyScene() override { world.shutDown(); }
  void ticks(int n) {
    for (int i = 0; i < n; ++i) world.update();
  }

 public:
  /// A HARD Object without mass.
  static Object* wall(Vector centre, Vector half) {
    auto* p_wall = new Object;
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

 protected:
  /// Per second.
  static Vector speedOf(const Body* p_body) {
    return Vector(30 * p_body->getVelocity().x(), 30 * p_body->getVelocity().y());
  }

  std::vector<std::string> log;
  World world;
  World::Scope scope;
};

/// Records its contact events.
class Listener : public Body {
 public:
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
  std::vector<Note> notes;
};

}  // namespace df::test
