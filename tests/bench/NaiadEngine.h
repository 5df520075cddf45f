// A Scene in this project's engine, with only the means of a game: Objects, their handlers and WM.update().
#pragma once

#include <vector>

#include "Engine.h"
#include "Scene.h"
#include "engine/events/EventOut.h"
#include "engine/managers/WorldManager.h"
#include "engine/world/EventCollision.h"
#include "engine/world/Object.h"
#include "engine/world/World.h"
#include "engine/world/WorldLog.h"
#include "engine/world/WorldStore.h"

namespace bench {

/// An Object of the workload, with handlers like a game's.
class Ball : public df::Object {
 public:
  Ball(const Body& body, std::uint64_t number, double side, Tally& tally)
      : m_tally(tally), m_number(number), m_side(side) {
    setType("Ball");
    setSolidness(body.solidness);
    if (body.width != 1 || body.height != 1) {
      setBox(df::Box(df::Vector(-body.width / 2.0, -body.height / 2.0), body.width, body.height));
    }
    setPosition(df::Vector(body.x, body.y));
    setVelocity(df::Vector(body.vx, body.vy));
  }

  int eventHandler(const df::Event* p_e) override {
    if (p_e->getType() == df::COLLISION_EVENT) return hit(static_cast<const df::EventCollision*>(p_e));
    if (p_e->getType() != df::OUT_EVENT) return 0;
    turnBack(*this, m_side);
    return 1;
  }

 private:
  int hit(const df::EventCollision* p_e) {
    m_tally.event(m_number);
    const bool is_mover = p_e->getObject1() == this;
    if (!is_mover || getSolidness() != df::HARD || p_e->getObject2()->getSolidness() != df::HARD) return 1;
    if (m_turned == m_tally.tick) return 1;  // it collided with several boxes in this tick
    m_turned = m_tally.tick;
    ++m_tally.blocked;
    reverse(*this);
    return 1;
  }

  Tally& m_tally;
  std::uint64_t m_number;
  std::uint64_t m_turned = 0;  // last tick in which it was blocked
  double m_side;
};

class NaiadEngine : public Engine {
 public:
  explicit NaiadEngine(const Scene& scene) {
    const df::World::Scope scope(m_world);
    m_world.log().setSink([](const std::string& /*line*/) {});
    WM.setBoundary(df::Box(df::Vector(), scene.side, scene.side));
    m_balls.reserve(scene.bodies.size());
    for (const Body& body : scene.bodies)
      m_balls.push_back(new Ball(body, m_balls.size(), scene.side, m_tally));
  }
  ~NaiadEngine() override { m_world.shutDown(); }

  void tick() override {
    const df::World::Scope scope(m_world);
    ++m_tally.tick;
    WM.update();
  }
  const Tally& tally() const override { return m_tally; }
  std::uint64_t stateHash() const override {
    StateHash hash;
    for (const Ball* ball : m_balls) {
      for (const df::Vector& vector : {ball->getPosition(), ball->getVelocity()}) {
        hash.add(vector.x());
        hash.add(vector.y());
      }
    }
    return hash.value();
  }
  const df::MoverStats& moverStats() const { return m_world.store().grid().moverStats(); }

 private:
  df::World m_world;
  Tally m_tally;
  std::vector<Ball*> m_balls;  // owned by the world, by id
};

}  // namespace bench
