// df::Body Objects with default settings; mass is in kg. A fixed, axis-parallel body is an ordinary HARD
// Object if bodies may touch it.
#include <algorithm>
#include <memory>
#include <numbers>
#include <vector>

#include "Default.h"
#include "ProductWorld.h"
#include "engine/world/EventCollision.h"
#include "physics/body/Body.h"
#include "physics/body/BodyLayer.h"
#include "physics/body/Field.h"
#include "physics/body/PhysicsManager.h"

namespace lab {
namespace {

df::Vector cells(Vec v) {
  return {v.x, v.y};
}

class SceneField : public df::Field {
 public:
  SceneField(lab::Field field, double tick) : m_field(std::move(field)), m_tick(tick) {}
  df::Vector accelerationAt(df::Vector way, df::Vector velocity, double time) const override {
    BodyState state;
    state.position = {way.x(), way.y()};
    state.velocity = {velocity.x() / m_tick, velocity.y() / m_tick};
    return cells(m_tick * m_tick * m_field(time * m_tick, state));
  }

 private:
  lab::Field m_field;
  double m_tick;
};

class CountingBody : public df::Body {
 public:
  explicit CountingBody(long& count) : m_count(count) {}
  int eventHandler(const df::Event* p_e) override {
    if (p_e->getType() != df::COLLISION_EVENT) return 0;
    if (static_cast<const df::EventCollision*>(p_e)->getObject1() == this) ++m_count;
    return 1;
  }

 private:
  long& m_count;
};

class DefaultBodies : public ProductWorld {
 public:
  DefaultBodies(df::Accuracy accuracy, const Scene& scene)
      : ProductWorld(scene),
        m_origin(scene.origin),
        m_is_hearing(scene.hearing),
        m_collides(scene.collides),
        m_counts_contacts(scene.counts_contacts) {
    const df::World::Scope scope(m_world);
    PM.setAspect(1);
    PM.setGravity(cells(m_tick * m_tick * scene.gravity));
    PM.setAccuracy(accuracy);
    PM.setSleeping(scene.may_sleep);
    if (scene.field) m_field = std::make_unique<SceneField>(scene.field, m_tick);
    m_p_layer = &naiad::physics::BodyLayer::of(m_world);
    chooseObstacles(scene);
    for (const Body& body : scene.bodies) add(body);
    for (const Joint& joint : scene.joints) add(joint);
  }
  ~DefaultBodies() override { clear(); }

  BodyState body(int index) const override {
    const df::Body* p_body = m_bodies[static_cast<std::size_t>(index)];
    if (p_body == nullptr) return {m_places[static_cast<std::size_t>(index)], {}, 0, 0};
    BodyState state = stateOf(p_body->getDisplacementFrom(cells(m_origin)), p_body->getVelocity());
    state.angle = p_body->getAngle();
    state.spin = p_body->getSpin() / m_tick;
    return state;
  }
  long contacts() const override { return m_contacts; }
  long frozen() const override {
    return std::count_if(m_bodies.begin(), m_bodies.end(),
                         [](const auto& p_body) { return p_body != nullptr && p_body->isFrozen(); });
  }
  std::optional<Work> work() const override {
    const naiad::physics::BodyLayer& layer = *m_p_layer;
    const auto contacts = layer.rigidCounters().contacts + layer.substepCounters().contacts +
                          layer.heapCounters().contacts + layer.sensorPairs();
    const auto impacts = layer.impactCounters().impacts + layer.rigidCounters().impacts;
    return Work{static_cast<double>(contacts), static_cast<double>(impacts)};
  }

 private:
  static bool isPlain(const Body& body) {
    return body.motion == Motion::FIXED && body.angle == 0 && body.shapes.size() == 1 &&
           body.shapes[0].kind == Shape::Kind::BOX;
  }
  bool isObstacle(const Body& body) const {
    return m_collides && isPlain(body) && body.friction == m_friction && body.restitution == m_restitution;
  }

  // Sets friction and restitution of plain Objects. All of them share those of the first one in the scene.
  void chooseObstacles(const Scene& scene) {
    for (const Body& body : scene.bodies) {
      if (!isPlain(body)) continue;
      m_friction = body.friction;
      m_restitution = body.restitution;
      PM.setObstacleFriction(m_friction);
      PM.setObstacleRestitution(m_restitution);
      return;
    }
  }

  void add(const Body& body) {
    m_places.push_back(body.position);
    if (isObstacle(body)) {
      m_bodies.push_back(nullptr);
      auto& obstacle = make<df::Object>();
      const Vec half = body.shapes[0].half;
      obstacle.setBox(df::Box(df::Vector(-half.x, -half.y), 2 * half.x, 2 * half.y));
      obstacle.setPosition(cells(m_origin + body.position));
      return;
    }
    df::Body& made = m_counts_contacts ? make<CountingBody>(m_contacts) : make<df::Body>();
    m_bodies.push_back(&made);
    if (body.shapes.empty() || !m_collides) made.setSolidness(df::SPECTRAL);
    if (m_is_hearing) made.setSolidness(df::SOFT);
    // Removes a body whose position is refused, because a game would have no other place for it.
    if (made.setPosition(cells(m_origin + body.position)) != 0) WM.removeObject(&made);
    addShapes(made, body.shapes);
    made.setAngle(body.angle);
    made.setVelocity(cells(m_tick * body.velocity));
    made.setSpin(m_tick * body.spin);
    made.setMass(body.mass);
    made.setFriction(body.friction);
    made.setRestitution(body.restitution);
    made.setTurning(body.rotates);
    if (body.motion != Motion::DYNAMIC) {
      made.setKinematic();
      return;
    }
    if (body.linear_drag > 0) made.setDrag(m_tick * body.linear_drag / body.mass);
    if (m_field) made.setField(m_field.get(), cells(m_origin));
  }

  // Adds parts. Their centres are relative to the mass centre of the parts added so far; in a scene, to that
  // of the whole body.
  static void addShapes(df::Body& made, const std::vector<Shape>& shapes) {
    double area = 0;
    Vec middle;
    for (const Shape& shape : shapes) {
      const bool is_round = shape.kind == Shape::Kind::CIRCLE;
      const bool is_part = shapes.size() > 1;
      const df::Vector centre = cells(shape.centre - middle);
      if (is_part && is_round) made.addCircle(shape.radius, centre);
      if (is_part && !is_round) made.addBoxShape(2 * shape.half.x, 2 * shape.half.y, centre);
      if (!is_part && is_round) made.setCircle(shape.radius);
      if (!is_part && !is_round) made.setBoxShape(2 * shape.half.x, 2 * shape.half.y);
      const double more =
          is_round ? std::numbers::pi * shape.radius * shape.radius : 4 * shape.half.x * shape.half.y;
      area += more;
      middle = middle + more / area * (shape.centre - middle);
    }
  }

  void add(const Joint& joint) {
    df::Body* p_a = joint.a < 0 ? nullptr : m_bodies[static_cast<std::size_t>(joint.a)];
    df::Body* p_b = joint.b < 0 ? nullptr : m_bodies[static_cast<std::size_t>(joint.b)];
    const df::Vector at_a = cells(m_origin + joint.anchor_a), at_b = cells(m_origin + joint.anchor_b);
    if (joint.kind == Joint::Kind::HINGE) {
      PM.addHinge(p_a, p_b, at_a);
      return;
    }
    if (joint.kind == Joint::Kind::ROD) {
      PM.addDistance(p_a, p_b, at_a, at_b);
      return;
    }
    PM.addSpring(p_a, p_b, at_a, at_b, m_tick * m_tick * joint.stiffness, m_tick * joint.damping)
        .setLength(joint.rest_length);
  }

  const naiad::physics::BodyLayer* m_p_layer = nullptr;
  Vec m_origin;
  bool m_is_hearing;
  bool m_collides;
  bool m_counts_contacts;
  double m_friction = -1;
  double m_restitution = -1;
  long m_contacts = 0;
  std::unique_ptr<SceneField> m_field;
  std::vector<Vec> m_places;        // indexed by scene body
  std::vector<df::Body*> m_bodies;  // indexed by scene body; null: an Object
};

}  // namespace

SimulationPtr bodiesAt(df::Accuracy accuracy, const Scene& scene) {
  return scene.rigid() || scene.hearing ? std::make_unique<DefaultBodies>(accuracy, scene) : nullptr;
}

}  // namespace lab
