#include <box2d/box2d.h>

#include <vector>

#include "Simulation.h"

namespace bench::physics {
namespace {

constexpr int kSteps = 4;
constexpr float kStep = 1 / (kSteps * static_cast<float>(Scene::kTicksPerSecond));
constexpr int kVelocityIterations = 8;
constexpr int kPositionIterations = 3;

float single(double value) {
  return static_cast<float>(value);
}

b2BodyType typeOf(Motion motion) {
  if (motion == Motion::STATIC) return b2_staticBody;
  return motion == Motion::KINEMATIC ? b2_kinematicBody : b2_dynamicBody;
}

class Box2dSimulation : public Simulation {
 public:
  explicit Box2dSimulation(const Scene& scene) : m_world({0, single(scene.gravity)}) {
    m_world.SetAllowSleeping(scene.sleep);
    const b2BodyDef nothing;
    m_p_ground = m_world.CreateBody(&nothing);
    m_bodies.reserve(scene.bodies.size());
    for (const Body& body : scene.bodies) add(body, scene.collide);
    for (const Hinge& hinge : scene.hinges) add(hinge);
  }

  void tick() override {
    for (int i = 0; i < kSteps; ++i) m_world.Step(kStep, kVelocityIterations, kPositionIterations);
  }

  Pose pose(std::size_t body) const override {
    const b2Transform& at = m_bodies[body]->GetTransform();
    return {at.p.x, at.p.y, at.q.c, at.q.s};
  }

  bool isFrozen(std::size_t /*body*/) const override { return false; }

 private:
  void add(const Body& body, bool collide) {
    b2BodyDef definition;
    definition.type = typeOf(body.motion);
    definition.position.Set(single(body.x), single(body.y));
    definition.linearVelocity.Set(single(body.vx), single(body.vy));
    definition.angularVelocity = single(body.spin);
    m_bodies.push_back(m_world.CreateBody(&definition));
    for (const Part& part : body.parts) add(part, body.density, collide);
  }

  // Adds a part to the newest body.
  void add(const Part& part, double density, bool collide) {
    b2FixtureDef fixture;
    b2CircleShape circle;
    b2PolygonShape polygon;
    const b2Vec2 centre(single(part.x), single(part.y));
    if (part.isCircle()) {
      circle.m_radius = single(part.radius);
      circle.m_p = centre;
      fixture.shape = &circle;
    } else {
      polygon.SetAsBox(single(part.half_width), single(part.half_height), centre, 0);
      fixture.shape = &polygon;
    }
    fixture.density = single(density);
    fixture.friction = single(Scene::kFriction);
    if (!collide) fixture.filter.maskBits = 0;
    m_bodies.back()->CreateFixture(&fixture);
  }

  void add(const Hinge& hinge) {
    const auto bodyOf = [&](int index) {
      return index == Hinge::kWorld ? m_p_ground : m_bodies[static_cast<std::size_t>(index)];
    };
    b2RevoluteJointDef definition;
    definition.Initialize(bodyOf(hinge.a), bodyOf(hinge.b), {single(hinge.x), single(hinge.y)});
    m_world.CreateJoint(&definition);
  }

  b2World m_world;
  b2Body* m_p_ground = nullptr;
  std::vector<b2Body*> m_bodies;  // owned by the world, by index in the scene
};

}  // namespace

SimulationPtr makeBox2d(const Scene& scene) {
  return std::make_unique<Box2dSimulation>(scene);
}

}  // namespace bench::physics
