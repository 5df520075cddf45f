#include <box2d/box2d.h>

#include <vector>

#include "Peers.h"

namespace bench {

namespace {

constexpr float kTickLength = 1;  // velocities are per tick
constexpr int kVelocityIterations = 8;
constexpr int kPositionIterations = 3;

// Kinematic bodies: they move by their velocity and nothing pushes them, as here.
class Box2dMotion : public Engine {
 public:
  explicit Box2dMotion(const Scene& scene) : m_world(b2Vec2_zero), m_side(static_cast<float>(scene.side)) {
    m_world.SetAllowSleeping(false);
    m_bodies.reserve(scene.bodies.size());
    for (const Body& body : scene.bodies) {
      b2BodyDef definition;
      definition.type = b2_kinematicBody;
      definition.position.Set(static_cast<float>(body.x), static_cast<float>(body.y));
      definition.linearVelocity.Set(static_cast<float>(body.vx), static_cast<float>(body.vy));
      definition.allowSleep = false;
      m_bodies.push_back(m_world.CreateBody(&definition));
    }
  }

  void tick() override {
    ++m_tally.tick;
    m_world.Step(kTickLength, kVelocityIterations, kPositionIterations);
    for (b2Body* body : m_bodies) {
      const b2Vec2& p = body->GetPosition();
      const bool left_x = !(p.x >= 0 && p.x < m_side);
      const bool left_y = !(p.y >= 0 && p.y < m_side);
      if (left_x || left_y) turnBack(*body, left_x, left_y);
    }
  }

  const Tally& tally() const override { return m_tally; }

  std::uint64_t stateHash() const override {
    StateHash hash;
    for (const b2Body* body : m_bodies) {
      hash.add(body->GetPosition().x);
      hash.add(body->GetPosition().y);
      hash.add(body->GetLinearVelocity().x);
      hash.add(body->GetLinearVelocity().y);
    }
    return hash.value();
  }

 private:
  static void turnBack(b2Body& body, bool left_x, bool left_y) {
    const b2Vec2 v = body.GetLinearVelocity();
    body.SetTransform(body.GetPosition() - v, 0);
    body.SetLinearVelocity({left_x ? -v.x : v.x, left_y ? -v.y : v.y});
  }

  b2World m_world;
  Tally m_tally;
  std::vector<b2Body*> m_bodies;  // the world's, by id
  float m_side;
};

}  // namespace

EnginePtr makeBox2dMotion(const Scene& scene) {
  return std::make_unique<Box2dMotion>(scene);
}

}  // namespace bench
