// Box2D 2.4.1 as built by Debian. `substeps` are whole steps of tick / substeps, with the velocity and
// position iterations that its manual recommends. It uses Box2D's defaults, except that nothing sleeps unless
// the scene allows it, and boxes are reduced by Box2D's polygon skin, so that they touch where the scene
// says, unless it requests full sides.
#include <box2d/box2d.h>

#include <algorithm>
#include <vector>

#include "tests/accuracy/frame/Method.h"

namespace lab {
namespace {

constexpr int kVelocityIterations = 8;
constexpr int kPositionIterations = 3;
constexpr float kFar = 1e10F;

float single(double value) {
  return static_cast<float>(value);
}

class ContactCounter : public b2ContactListener {
 public:
  void BeginContact(b2Contact*) override { ++count; }
  long count = 0;
};

class Box2d : public Simulation {
 public:
  explicit Box2d(const Scene& scene)
      : m_world({single(scene.gravity.x), single(scene.gravity.y)}),
        m_field(scene.field),
        m_origin(scene.origin),
        m_collides(scene.collides),
        m_skin(scene.has_full_sides ? 0 : b2_polygonRadius) {
    m_world.SetAllowSleeping(scene.may_sleep);
    if (scene.counts_contacts) m_world.SetContactListener(&m_contacts);
    const b2BodyDef nothing;
    m_ground = m_world.CreateBody(&nothing);
    m_bodies.reserve(scene.bodies.size());
    for (const Body& body : scene.bodies) add(body);
    for (const Joint& joint : scene.joints) add(joint);
  }

  void step(double tick, int substeps) override {
    const double h = tick / substeps;
    for (int i = 0; i < substeps; ++i) {
      if (m_field) push();
      m_world.Step(single(h), kVelocityIterations, kPositionIterations);
      m_time += h;
    }
  }

  BodyState body(int index) const override { return stateOf(*m_bodies[static_cast<std::size_t>(index)]); }
  long contacts() const override { return m_contacts.count; }

 private:
  b2Vec2 at(Vec position) const { return {single(m_origin.x + position.x), single(m_origin.y + position.y)}; }

  BodyState stateOf(const b2Body& body) const {
    const b2Vec2& p = body.GetPosition();
    const b2Vec2& v = body.GetLinearVelocity();
    return {{p.x - m_origin.x, p.y - m_origin.y}, {v.x, v.y}, body.GetAngle(), body.GetAngularVelocity()};
  }

  void add(const Body& body) {
    b2BodyDef definition;
    definition.type = body.motion == Motion::DYNAMIC     ? b2_dynamicBody
                      : body.motion == Motion::KINEMATIC ? b2_kinematicBody
                                                         : b2_staticBody;
    definition.position = at(body.position);
    definition.angle = single(body.angle);
    definition.linearVelocity.Set(single(body.velocity.x), single(body.velocity.y));
    definition.angularVelocity = single(body.spin);
    definition.linearDamping = single(body.linear_drag / body.mass);
    definition.fixedRotation = !body.rotates;
    definition.bullet = body.fast;
    b2Body* made = m_world.CreateBody(&definition);
    double inertia = 0;  // of the last shape, per mass
    for (const Shape& shape : body.shapes) {
      addShape(*made, body, shape);
      inertia = inertiaOf(shape);
    }
    if (body.motion == Motion::DYNAMIC) {
      b2MassData mass{single(body.mass), b2Vec2_zero, body.rotates ? single(body.mass * inertia) : 0.0F};
      made->SetMassData(&mass);
    }
    m_bodies.push_back(made);
  }

  void addShape(b2Body& made, const Body& body, const Shape& shape) const {
    b2FixtureDef fixture;
    if (!m_collides) fixture.filter.maskBits = 0;
    fixture.friction = single(body.friction);
    fixture.restitution = single(body.restitution);
    fixture.density = 1;
    if (shape.kind == Shape::Kind::CIRCLE) {
      b2CircleShape circle;
      circle.m_p = {single(shape.centre.x), single(shape.centre.y)};
      circle.m_radius = single(shape.radius);
      fixture.shape = &circle;
      made.CreateFixture(&fixture);
      return;
    }
    b2PolygonShape polygon;
    polygon.SetAsBox(std::max(single(shape.half.x) - m_skin, b2_linearSlop),
                     std::max(single(shape.half.y) - m_skin, b2_linearSlop),
                     {single(shape.centre.x), single(shape.centre.y)}, 0);
    fixture.shape = &polygon;
    made.CreateFixture(&fixture);
  }

  void add(const Joint& joint) {
    if (joint.kind == Joint::Kind::HINGE) {
      b2RevoluteJointDef definition;
      definition.Initialize(bodyOf(joint.a), bodyOf(joint.b), at(joint.anchor_a));
      m_world.CreateJoint(&definition);
      return;
    }
    b2DistanceJointDef definition;
    definition.Initialize(bodyOf(joint.a), bodyOf(joint.b), at(joint.anchor_a), at(joint.anchor_b));
    if (joint.kind == Joint::Kind::SPRING) {
      definition.length = single(joint.rest_length);
      definition.minLength = 0;
      definition.maxLength = kFar;
      definition.stiffness = single(joint.stiffness);
      definition.damping = single(joint.damping);
    }
    m_world.CreateJoint(&definition);
  }

  b2Body* bodyOf(int index) const { return index < 0 ? m_ground : m_bodies[static_cast<std::size_t>(index)]; }

  void push() {
    for (b2Body* body : m_bodies) {
      const Vec acceleration = m_field(m_time, stateOf(*body));
      body->ApplyForceToCenter(
          {body->GetMass() * single(acceleration.x), body->GetMass() * single(acceleration.y)}, true);
    }
  }

  b2World m_world;
  ContactCounter m_contacts;
  Field m_field;
  Vec m_origin;
  bool m_collides;
  float m_skin;
  double m_time = 0;
  b2Body* m_ground = nullptr;
  std::vector<b2Body*> m_bodies;  // owned by the world, indexed by scene body
};

const RegisteredMethod method({"box2d", "Box2D 2.4", "2.4.1", Method::Kind::PEER,
                               [](const Scene& scene) -> SimulationPtr {
                                 return scene.rigid() ? std::make_unique<Box2d>(scene) : nullptr;
                               }});

}  // namespace
}  // namespace lab
