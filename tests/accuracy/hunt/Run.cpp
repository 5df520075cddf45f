// Builds a world from a scene, through the public API, and records it.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>

#include "Recording.h"
#include "Script.h"
#include "Solids.h"
#include "engine/managers/WorldManager.h"
#include "engine/world/EventCollision.h"
#include "engine/world/World.h"
#include "engine/world/WorldLog.h"
#include "physics/body/Body.h"
#include "physics/body/EventContactEnd.h"
#include "physics/body/Field.h"
#include "physics/geometry/Rotation.h"

namespace hunt {
namespace {

using df::Vector;
using naiad::physics::inverse;
using naiad::physics::rotationBy;

// Above this square of an oscillation's rate, per tick², the energy of a spring is not followed.
constexpr double kStiff = .5;

// Calls a function and writes the call. `target` is an expression that ends with . or ->, `before` its text.
#define CALL(before, target, function, ...) \
  (m_script.call(before, #function, __VA_ARGS__), target function(__VA_ARGS__))

std::string element(const char* list, std::size_t index) {
  return list + ("[" + std::to_string(index)) + "]";
}

df::Solidness chosenSolidness(const Action& action) {
  return static_cast<df::Solidness>(static_cast<int>(action.x));
}

class LiveScene;

class HuntField : public df::Field {
 public:
  explicit HuntField(const FieldData& data) : m_data(data) {}
  Vector accelerationAt(Vector d, Vector v, double /*time*/) const override {
    const double k = m_data.strength, c = m_data.steepness;
    if (m_data.kind == FieldData::Kind::LINEAR) return {-k * d.x(), -k * d.y()};
    if (m_data.kind == FieldData::Kind::MAGNET) return {-k * v.y(), k * v.x()};
    return {-k * df::math::tanh(c * d.x()), -k * df::math::tanh(c * d.y())};
  }

 private:
  FieldData m_data;
};

// Returns the integral of tanh(c x) from 0 to x.
double tanhPotential(double c, double x) {
  const double u = std::abs(c * x);
  return (u + std::log1p(std::exp(-2 * u)) - std::log(2.0)) / c;
}

// Returns the potential of a force that grows with k x up to a limit.
double limitedPotential(double k, double x, double limit) {
  const double u = std::abs(x);
  return k * u <= limit ? .5 * k * u * u : limit * u - .5 * limit * limit / k;
}

class HuntBody : public df::Body {
 public:
  HuntBody(LiveScene& scene, int index) : m_scene(scene), m_index(index) {}
  ~HuntBody() override;
  int eventHandler(const df::Event* p_event) override;
  std::string code() const { return element("bodies", static_cast<std::size_t>(m_index)); }

 private:
  LiveScene& m_scene;
  int m_index;
};

class HuntObstacle : public df::Object {
 public:
  HuntObstacle(LiveScene& scene, int index) : m_scene(scene), m_index(index) {}
  ~HuntObstacle() override;

 private:
  LiveScene& m_scene;
  int m_index;
};

class LiveScene {
 public:
  LiveScene(const SceneData& scene, Detail detail, const std::vector<BodyState>* p_start, bool writes);
  ~LiveScene() { m_world.shutDown(); }
  LiveScene(const LiveScene&) = delete;
  LiveScene& operator=(const LiveScene&) = delete;

  Recording record();
  /// Returns the calls since the start as a program.
  std::string program(const std::string& comment) const;
  void forgetBody(int index) { m_bodies[static_cast<std::size_t>(index)] = nullptr; }
  void forgetObstacle(int index) { m_obstacles[static_cast<std::size_t>(index)] = nullptr; }
  void onContact(int receiver, bool begins, const df::Object* p_first, const df::Object* p_second);

 private:
  Vector cells(Vec2 metric) const { return {metric.x, metric.y / m_now.aspect}; }
  Vec2 metric(Vector cells) const { return {cells.x(), cells.y() * m_now.aspect}; }
  HuntBody* bodyAt(int index) const {
    return index == kNothing ? nullptr : m_bodies[static_cast<std::size_t>(index)];
  }

  void addGroup(int group);
  void addBody(std::size_t index);
  void addPart(HuntBody& body, const std::string& on, const Part& part, bool is_first);
  void addObstacle(std::size_t index);
  void addJoint(std::size_t index);
  void setStates(const std::vector<BodyState>& states);

  void tick(int number);
  void actAt(int tick);
  void act(Action& action);
  void actOnBody(const Action& action, HuntBody& body, BodyData& data);
  void actOnObstacle(const Action& action, HuntObstacle& obstacle, ObstacleData& data);
  void actOnJoint(const Action& action, df::Joint& joint, JointData& data);
  void actOnWorld(const Action& action);

  void recordTick();
  Sums sums() const;
  void addPotential(std::size_t index, Sums& sums) const;
  void addJointPotential(std::size_t index, Sums& sums) const;
  void recordSolids(Tick& tick);
  void recordOpenings(Tick& tick) const;
  void recordContacts(Tick& tick);
  Solid solidOf(std::size_t body) const;
  Solid solidOf(const ObstacleData& obstacle) const;
  void recordPair(Tick& tick, int a, int b);
  double turnOf(const JointData& joint, double lever) const;
  bool areJoined(int a, int b) const;
  double travelOf(int number) const { return number < 0 ? 0 : m_travels[static_cast<std::size_t>(number)]; }
  const Solid* solidAt(int number) const;
  double gapOf(int a, int b) const;
  df::Solidness solidnessOf(int number) const;
  Vec2 anchorOf(const JointData& joint, bool second) const;

  const Detail m_detail;
  SceneData m_now;
  Recording m_recording;
  Script m_script;
  df::World m_world;
  df::World::Scope m_scope{m_world};
  std::vector<std::unique_ptr<HuntField>> m_fields;
  std::vector<HuntBody*> m_bodies;
  std::vector<HuntObstacle*> m_obstacles;
  std::vector<df::Joint> m_joints;
  std::map<const df::Object*, int> m_numbers;
  int m_tick = 0;
  bool m_acted = false;                           // in this tick
  bool m_displaces = false, m_displaced = false;  // in this tick; ever
  std::vector<int> m_event_counts;                // by receiver
  std::vector<double> m_travels;                  // bounds of the bodies' motion in this tick
  std::vector<Solid> m_body_solids, m_obstacle_solids;
  std::vector<std::pair<int, int>> m_excluded;  // pairs that overlapped after an action or at the start
  std::vector<OpenContact> m_open;
};

HuntBody::~HuntBody() {
  m_scene.forgetBody(m_index);
}

HuntObstacle::~HuntObstacle() {
  m_scene.forgetObstacle(m_index);
}

int HuntBody::eventHandler(const df::Event* p_event) {
  if (p_event->getType() == df::COLLISION_EVENT) {
    const auto* p_begin = static_cast<const df::EventCollision*>(p_event);
    m_scene.onContact(m_index, true, p_begin->getObject1(), p_begin->getObject2());
  } else if (p_event->getType() == df::CONTACT_END_EVENT) {
    const auto* p_end = static_cast<const df::EventContactEnd*>(p_event);
    m_scene.onContact(m_index, false, p_end->getObject1(), p_end->getObject2());
  }
  return 1;
}

LiveScene::LiveScene(const SceneData& scene, Detail detail, const std::vector<BodyState>* p_start,
                     bool writes)
    : m_detail(detail),
      m_now(scene),
      m_script(writes),
      m_bodies(scene.bodies.size()),
      m_obstacles(scene.obstacles.size()),
      m_joints(scene.joints.size()),
      m_event_counts(scene.bodies.size()),
      m_travels(scene.bodies.size()),
      m_body_solids(scene.bodies.size()),
      m_obstacle_solids(scene.obstacles.size()) {
  m_world.log().setSink([](const std::string&) {});
  CALL("PM.", PM., setAspect, scene.aspect);
  CALL("PM.", PM., setGravity, cells(scene.gravity));
  CALL("PM.", PM., setObstacleFriction, scene.obstacle_friction);
  CALL("PM.", PM., setObstacleRestitution, scene.obstacle_restitution);
  CALL("PM.", PM., setAccuracy, scene.level);
  CALL("PM.", PM., setSleeping, scene.sleeping);
  for (const FieldData& field : scene.fields) m_fields.push_back(std::make_unique<HuntField>(field));
  for (int i = 0; i < 2; ++i) addGroup(scene.later_groups_first ? 1 - i : i);
  if (p_start != nullptr) setStates(*p_start);
}

void LiveScene::addGroup(int group) {
  for (std::size_t i = 0; i < m_now.obstacles.size(); ++i) {
    if (m_now.obstacles[i].present && m_now.obstacles[i].group == group) addObstacle(i);
  }
  for (std::size_t i = 0; i < m_now.bodies.size(); ++i) {
    if (m_now.bodies[i].present && m_now.bodies[i].group == group) addBody(i);
  }
  for (std::size_t i = 0; i < m_now.joints.size(); ++i) {
    if (m_now.joints[i].present && m_now.groupOf(m_now.joints[i]) == group) addJoint(i);
  }
}

void LiveScene::addBody(std::size_t index) {
  const BodyData& data = m_now.bodies[index];
  auto* p_body = new HuntBody(*this, static_cast<int>(index));
  m_bodies[index] = p_body;
  m_numbers[p_body] = static_cast<int>(index);
  const std::string name = element("bodies", index), on = name + "->";
  m_script.add(name + " = new TracedBody(" + std::to_string(index) + ");");
  for (std::size_t i = 0; i < data.parts.size(); ++i) addPart(*p_body, on, data.parts[i], i == 0);
  CALL(on, p_body->, setPosition, cells(data.place));
  CALL(on, p_body->, setVelocity, cells(data.velocity));
  CALL(on, p_body->, setAngle, data.angle);
  CALL(on, p_body->, setSpin, data.spin);
  CALL(on, p_body->, setMass, data.mass);
  CALL(on, p_body->, setRestitution, data.restitution);
  CALL(on, p_body->, setFriction, data.friction);
  CALL(on, p_body->, setTurning, data.turning);
  if (data.kinematic) CALL(on, p_body->, setKinematic, true);
  if (data.solidness != df::HARD) CALL(on, p_body->, setSolidness, data.solidness);
  if (data.contact_ends) CALL(on, p_body->, setContactEnds, true);
  if (data.gravity_scale != 1) CALL(on, p_body->, setGravityScale, data.gravity_scale);
  if (data.linear_drag != 0 || data.quadratic_drag != 0)
    CALL(on, p_body->, setDrag, data.linear_drag, data.quadratic_drag);
  if (data.stiffness != 0 || data.damping != 0)
    CALL(on, p_body->, setSpring, cells(data.anchor), data.stiffness, data.damping);
  if (data.field == kNothing) return;
  const auto field = static_cast<std::size_t>(data.field);
  m_script.call(on, "setField", Code{"&field" + std::to_string(field)}, cells(data.field_origin));
  p_body->setField(m_fields[field].get(), cells(data.field_origin));
}

void LiveScene::addPart(HuntBody& body, const std::string& on, const Part& part, bool is_first) {
  const Vector size = cells(part.size), centre = cells(part.centre);
  std::vector<Vector> corners;
  for (const Vec2 corner : part.corners) corners.push_back(cells(corner));
  if (part.kind == Part::Kind::CIRCLE && is_first) CALL(on, body., setCircle, part.size.x);
  if (part.kind == Part::Kind::CIRCLE && !is_first) CALL(on, body., addCircle, part.size.x, centre);
  if (part.kind == Part::Kind::BOX && is_first) CALL(on, body., setBoxShape, size.x(), size.y());
  if (part.kind == Part::Kind::BOX && !is_first)
    CALL(on, body., addBoxShape, size.x(), size.y(), centre, part.angle);
  if (part.kind == Part::Kind::POLYGON && is_first) CALL(on, body., setPolygon, corners);
  if (part.kind == Part::Kind::POLYGON && !is_first) CALL(on, body., addPolygon, corners);
}

void LiveScene::addObstacle(std::size_t index) {
  const ObstacleData& data = m_now.obstacles[index];
  auto* p_obstacle = new HuntObstacle(*this, static_cast<int>(index));
  m_obstacles[index] = p_obstacle;
  m_numbers[p_obstacle] = obstacleNumber(static_cast<int>(index));
  const std::string name = element("obstacles", index), on = name + "->";
  const Vector half = cells(data.half);
  m_script.add(name + " = new df::Object;");
  CALL(on, p_obstacle->, setBox, df::Box(Vector(-half.x(), -half.y()), 2 * half.x(), 2 * half.y()));
  CALL(on, p_obstacle->, setPosition, cells(data.centre));
  if (data.solidness != df::HARD) CALL(on, p_obstacle->, setSolidness, data.solidness);
}

void LiveScene::addJoint(std::size_t index) {
  JointData& data = m_now.joints[index];
  HuntBody *p_a = bodyAt(data.a), *p_b = bodyAt(data.b);
  if ((p_a == nullptr && data.a != kNothing) || (p_b == nullptr && data.b != kNothing)) return;
  const Vector a = cells(data.point_a), b = cells(data.point_b);
  const std::string name = element("joints", index), on = name + ".", add = name + " = PM.";
  df::Joint& joint = m_joints[index];
  using Kind = JointData::Kind;
  if (data.kind == Kind::DISTANCE) joint = CALL(add, PM., addDistance, p_a, p_b, a, b);
  if (data.kind == Kind::ROPE) joint = CALL(add, PM., addRope, p_a, p_b, a, b);
  if (data.kind == Kind::HINGE) joint = CALL(add, PM., addHinge, p_a, p_b, a);
  if (data.kind == Kind::WELD) joint = CALL(add, PM., addWeld, p_a, p_b, a);
  if (data.kind == Kind::SLIDER) joint = CALL(add, PM., addSlider, p_a, p_b, a, cells(data.axis));
  if (data.kind == Kind::SPRING) joint = CALL(add, PM., addSpring, p_a, p_b, a, b, data.first, data.second);
  if (data.kind == Kind::MOTOR) joint = CALL(add, PM., addMotor, p_a, p_b, data.first, data.second);
  if (data.kind == Kind::LIMIT) joint = CALL(add, PM., addAngleLimit, p_a, p_b, data.first, data.second);
  if (data.kind == Kind::MOUSE) {
    joint = CALL(add, PM., addMouse, p_b, b, data.first);
    if (data.second == 0) data.second = p_b->getMass();
    CALL(on, joint., setStiffness, data.second, 2 * data.second);
    if (data.has_target) CALL(on, joint., setTarget, cells(data.target));
  }
  if (data.length > 0) CALL(on, joint., setLength, data.length);
  if (data.break_force > 0) CALL(on, joint., setBreakForce, data.break_force);
}

void LiveScene::setStates(const std::vector<BodyState>& states) {
  for (std::size_t i = 0; i < states.size(); ++i) {
    HuntBody* p_body = m_bodies[i];
    if (p_body == nullptr || !states[i].present) continue;
    const std::string on = element("bodies", i) + "->";
    CALL(on, p_body->, setPosition, cells(states[i].place));
    CALL(on, p_body->, setVelocity, cells(states[i].velocity));
    CALL(on, p_body->, setAngle, states[i].angle);
    CALL(on, p_body->, setSpin, states[i].spin);
  }
}

Recording LiveScene::record() {
  recordTick();
  for (m_tick = 1; m_tick <= m_now.ticks; ++m_tick) {
    m_acted = m_displaces = false;
    actAt(m_tick);
    m_script.update();
    m_world.update();
    recordTick();
  }
  m_recording.frozen = PM.getQuarantineCount();
  m_recording.limited = PM.getLimitCount();
  for (std::size_t i = 0; i < m_joints.size(); ++i) {
    if (!m_joints[i].exists()) m_now.joints[i].present = false;  // it broke, or lost a body
  }
  m_recording.end = m_now;
  return std::move(m_recording);
}

void LiveScene::actAt(int tick) {
  for (Action& action : m_now.actions) {
    if (action.present && action.when == Action::When::TICK && action.tick == tick) act(action);
  }
}

void LiveScene::onContact(int receiver, bool begins, const df::Object* p_first, const df::Object* p_second) {
  const auto numberOf = [this](const df::Object* p_object) {
    const auto found = m_numbers.find(p_object);
    return found == m_numbers.end() ? kNothing : found->second;
  };
  m_recording.events.push_back({m_tick, begins, receiver, numberOf(p_first), numberOf(p_second), -1});
  const int count = m_event_counts[static_cast<std::size_t>(receiver)]++;
  for (Action& action : m_now.actions) {
    const auto when = begins ? Action::When::BEGIN : Action::When::END;
    if (!action.present || action.when != when || action.receiver != receiver || action.tick > m_tick)
      continue;
    if (action.kind == Action::Kind::DELETE_BODY && action.target == receiver)
      action.kind = Action::Kind::MARK_BODY;  // a handler of the body itself is running
    m_script.beginHandler(receiver, count);
    act(action);
    m_script.endHandler();
    return;
  }
}

void LiveScene::act(Action& action) {
  action.present = false;
  const auto target = static_cast<std::size_t>(action.target);
  switch (targetOf(action.kind)) {
    case TargetKind::BODY:
      if (m_bodies[target] == nullptr) return;
      actOnBody(action, *m_bodies[target], m_now.bodies[target]);
      break;
    case TargetKind::OBSTACLE:
      if (m_obstacles[target] == nullptr) return;
      actOnObstacle(action, *m_obstacles[target], m_now.obstacles[target]);
      break;
    case TargetKind::JOINT:
      if (!m_joints[target].exists()) return;
      actOnJoint(action, m_joints[target], m_now.joints[target]);
      break;
    case TargetKind::WORLD:
      actOnWorld(action);
      break;
  }
  m_acted = true;
  m_displaces = m_displaces || displaces(action.kind);
  m_displaced = m_displaced || m_displaces;
}

void LiveScene::actOnBody(const Action& action, HuntBody& body, BodyData& data) {
  using Kind = Action::Kind;
  const std::string name = element("bodies", static_cast<std::size_t>(action.target)), on = name + "->";
  const Vector value = cells({action.x, action.y}), place = body.getPosition();
  const Kind kind = action.kind;
  if (kind == Kind::MASS) CALL(on, body., setMass, data.mass = action.x);
  if (kind == Kind::RESTITUTION) CALL(on, body., setRestitution, data.restitution = action.x);
  if (kind == Kind::FRICTION) CALL(on, body., setFriction, data.friction = action.x);
  if (kind == Kind::TURNING) CALL(on, body., setTurning, data.turning = action.x != 0);
  if (kind == Kind::KINEMATIC) CALL(on, body., setKinematic, data.kinematic = action.x != 0);
  if (kind == Kind::SOLIDNESS) CALL(on, body., setSolidness, data.solidness = chosenSolidness(action));
  if (kind == Kind::VELOCITY) CALL(on, body., setVelocity, value);
  if (kind == Kind::SPIN) CALL(on, body., setSpin, action.x);
  if (kind == Kind::POSITION) CALL(on, body., setPosition, place + value);
  if (kind == Kind::ANGLE) CALL(on, body., setAngle, action.x);
  if (kind == Kind::GRAVITY_SCALE) CALL(on, body., setGravityScale, data.gravity_scale = action.x);
  if (kind == Kind::DRAG) CALL(on, body., setDrag, data.linear_drag = action.x, data.quadratic_drag = 0);
  if (kind == Kind::IMPULSE) CALL(on, body., applyImpulse, value);
  if (kind == Kind::FORCE) CALL(on, body., applyForce, value);
  if (kind == Kind::SPRING) {
    data.anchor = metric(place);
    CALL(on, body., setSpring, place, data.stiffness = action.x, data.damping = action.y);
  }
  if (kind == Kind::CIRCLE || kind == Kind::BOX) {
    const auto part = kind == Kind::BOX ? Part::Kind::BOX : Part::Kind::CIRCLE;
    data.parts = {{.kind = part, .size = {action.x, action.y}}};
    addPart(body, on, data.parts[0], true);
  }
  if (kind == Kind::MARK_BODY || kind == Kind::DELETE_BODY) data.present = false;
  if (kind == Kind::MARK_BODY) {
    m_script.add("WM.markForDelete(" + name + ");");
    WM.markForDelete(&body);
  } else if (kind == Kind::DELETE_BODY) {
    m_script.add("delete " + name + ";");
    delete &body;
  }
}

void LiveScene::actOnObstacle(const Action& action, HuntObstacle& obstacle, ObstacleData& data) {
  const std::string name = element("obstacles", static_cast<std::size_t>(action.target)), on = name + "->";
  if (action.kind == Action::Kind::DELETE_OBSTACLE) {
    data.present = false;
    m_script.add("delete " + name + ";");
    delete &obstacle;
  } else if (action.kind == Action::Kind::MOVE_OBSTACLE) {
    data.centre += {action.x, action.y};
    CALL(on, obstacle., setPosition, cells(data.centre));
  } else {
    CALL(on, obstacle., setSolidness, data.solidness = chosenSolidness(action));
  }
}

void LiveScene::actOnJoint(const Action& action, df::Joint& joint, JointData& data) {
  using Kind = Action::Kind;
  const std::string on = element("joints", static_cast<std::size_t>(action.target)) + ".";
  const bool is_mouse = data.kind == JointData::Kind::MOUSE;
  const double x = action.x, y = action.y;
  if (action.kind == Kind::REMOVE_JOINT) {
    data.present = false;
    m_script.add(on + "remove();");
    joint.remove();
  }
  if (action.kind == Kind::JOINT_LENGTH && CALL(on, joint., setLength, x) == 0) data.length = x;
  if (action.kind == Kind::JOINT_STIFFNESS && !is_mouse && CALL(on, joint., setStiffness, x, y) == 0) {
    data.first = x;
    data.second = y;
  }
  if (action.kind == Kind::JOINT_SPEED && CALL(on, joint., setSpeed, x) == 0) data.first = x;
  if (action.kind == Kind::JOINT_STRENGTH && CALL(on, joint., setStrength, x) == 0)
    (is_mouse ? data.first : data.second) = x;
  if (action.kind == Kind::JOINT_LIMITS && CALL(on, joint., setLimits, x, y) == 0) {
    data.first = x;
    data.second = y;
  }
  if (action.kind == Kind::JOINT_TARGET) {
    const Vec2 target = data.point_b + Vec2{x, y};
    if (CALL(on, joint., setTarget, cells(target)) != 0) return;
    data.has_target = true;
    data.target = target;
  }
}

void LiveScene::actOnWorld(const Action& action) {
  using Kind = Action::Kind;
  if (action.kind == Kind::GRAVITY) m_now.gravity = {action.x, action.y};
  if (action.kind == Kind::GRAVITY) CALL("PM.", PM., setGravity, cells(m_now.gravity));
  if (action.kind == Kind::OBSTACLE_FRICTION)
    CALL("PM.", PM., setObstacleFriction, m_now.obstacle_friction = action.x);
  if (action.kind == Kind::OBSTACLE_RESTITUTION)
    CALL("PM.", PM., setObstacleRestitution, m_now.obstacle_restitution = action.x);
  if (action.kind == Kind::LEVEL) m_now.level = action.x != 0 ? df::ACCURACY_FAST : df::ACCURACY_DEFAULT;
  if (action.kind == Kind::LEVEL) CALL("PM.", PM., setAccuracy, m_now.level);
  if (action.kind == Kind::SLEEPING) CALL("PM.", PM., setSleeping, m_now.sleeping = action.x != 0);
}

std::string LiveScene::program(const std::string& comment) const {
  std::string fields;
  for (std::size_t i = 0; i < m_now.fields.size(); ++i) {
    const FieldData& field = m_now.fields[i];
    const std::string k = Script::codeOf(field.strength), c = Script::codeOf(field.steepness);
    std::string result = "-" + k + " * d.x(), -" + k + " * d.y()";
    if (field.kind == FieldData::Kind::MAGNET) result = "-" + k + " * v.y(), " + k + " * v.x()";
    if (field.kind == FieldData::Kind::TANH)
      result = "-" + k + " * std::tanh(" + c + " * d.x()), -" + k + " * std::tanh(" + c + " * d.y())";
    fields +=
        "struct : df::Field {\n  Vector accelerationAt([[maybe_unused]] Vector d, [[maybe_unused]] Vector v, "
        "double) const override {\n    return {" +
        result + "};\n  }\n} field" + std::to_string(i) + ";\n\n";
  }
  return m_script.program(comment, fields, m_bodies.size(), m_obstacles.size(), m_joints.size());
}

void LiveScene::recordTick() {
  Tick tick;
  tick.acted = m_acted;
  tick.displaced = m_displaced;
  for (const HuntBody* p_body : m_bodies) {
    BodyState state;
    if (p_body != nullptr) {
      state = {metric(p_body->getPosition()),
               metric(p_body->getVelocity()),
               p_body->getAngle(),
               p_body->getSpin(),
               true,
               p_body->isFrozen()};
    }
    tick.bodies.push_back(state);
  }
  if (m_detail == Detail::ALL) {
    m_recording.ticks.push_back(tick);
    Tick& its = m_recording.ticks.back();
    its.sums = sums();
    recordSolids(its);
    recordOpenings(its);
    recordContacts(its);
  } else {
    m_recording.ticks.push_back(std::move(tick));
  }
}

Sums LiveScene::sums() const {
  Sums sums;
  double mass = 0;
  Vec2 middle;
  for (std::size_t i = 0; i < m_bodies.size(); ++i) {
    const BodyData& data = m_now.bodies[i];
    if (m_bodies[i] == nullptr || data.kinematic || data.group != 0) continue;
    mass += data.mass;
    middle += data.mass * metric(m_bodies[i]->getPosition());
    sums.momentum += data.mass * metric(m_bodies[i]->getVelocity());
    sums.force += data.mass * data.gravity_scale * m_now.gravity;
    addPotential(i, sums);
  }
  if (mass == 0) return sums;
  middle = middle / mass;
  const Vec2 drift = sums.momentum / mass;
  for (std::size_t i = 0; i < m_bodies.size(); ++i) {
    const BodyData& data = m_now.bodies[i];
    if (m_bodies[i] == nullptr || data.kinematic || data.group != 0) continue;
    const Vec2 v = metric(m_bodies[i]->getVelocity());
    const double turning = m_bodies[i]->isTurning() ? m_bodies[i]->getInertia() * m_bodies[i]->getSpin() : 0;
    sums.kinetic += .5 * (data.mass * dot(v, v) + turning * m_bodies[i]->getSpin());
    sums.momentum_scale += data.mass * length(v);
    const Vec2 from = metric(m_bodies[i]->getPosition()) - middle;
    sums.angular += turning + data.mass * cross(from, v - drift);
    sums.angular_scale += std::abs(turning) + data.mass * length(from) * length(v - drift);
  }
  for (std::size_t i = 0; i < m_joints.size(); ++i) addJointPotential(i, sums);
  return sums;
}

void LiveScene::addPotential(std::size_t index, Sums& sums) const {
  const BodyData& data = m_now.bodies[index];
  const Vec2 place = metric(m_bodies[index]->getPosition());
  const Vec2 weight = data.mass * data.gravity_scale * m_now.gravity;
  sums.potential -= dot(weight, place);
  sums.pull += length(weight);
  sums.rest += .5 * dot(weight, weight) / (16 * data.mass);
  if (data.stiffness > 0) {
    const Vec2 d = place - data.anchor;
    (data.stiffness > kStiff ? sums.stiff : sums.potential) += .5 * data.mass * data.stiffness * dot(d, d);
    sums.pull += data.mass * data.stiffness * length(d);
  }
  if (data.field == kNothing) return;
  const FieldData& field = m_now.fields[static_cast<std::size_t>(data.field)];
  const Vec2 d = place - data.field_origin;
  if (field.kind == FieldData::Kind::LINEAR) {
    (field.strength > kStiff ? sums.stiff : sums.potential) += .5 * data.mass * field.strength * dot(d, d);
    sums.pull += data.mass * field.strength * length(d);
  } else if (field.kind == FieldData::Kind::TANH) {
    (field.strength * field.steepness > kStiff ? sums.stiff : sums.potential) +=
        data.mass * field.strength *
        (tanhPotential(field.steepness, d.x) + tanhPotential(field.steepness, d.y));
    sums.pull += 2 * data.mass * field.strength;
  }
}

void LiveScene::addJointPotential(std::size_t index, Sums& sums) const {
  const JointData& data = m_now.joints[index];
  if (!m_joints[index].exists() || m_now.groupOf(data) != 0) return;
  if (data.kind == JointData::Kind::SPRING) {
    const double rest = data.length > 0 ? data.length : length(data.point_b - data.point_a);
    const double stretch = length(anchorOf(data, true) - anchorOf(data, false)) - rest;
    double lightest = std::numeric_limits<double>::infinity();
    for (const int end : {data.a, data.b}) {
      if (end != kNothing) lightest = std::min(lightest, m_now.bodies[static_cast<std::size_t>(end)].mass);
    }
    (data.first > kStiff * lightest ? sums.stiff : sums.potential) += .5 * data.first * stretch * stretch;
    sums.pull += data.first * std::abs(stretch);
  } else if (data.kind == JointData::Kind::MOUSE) {
    const Vec2 d = anchorOf(data, true) - (data.has_target ? data.target : data.point_b);
    sums.potential +=
        limitedPotential(data.second, d.x, data.first) + limitedPotential(data.second, d.y, data.first);
    sums.pull += std::min(data.second * length(d), 2 * data.first);
  }
}

// Returns where the end of a joint is now.
Vec2 LiveScene::anchorOf(const JointData& joint, bool second) const {
  const int index = second ? joint.b : joint.a;
  const Vec2 point = second ? joint.point_b : joint.point_a;
  if (index == kNothing) return point;
  const HuntBody& body = *bodyAt(index);
  const BodyData& start = m_now.bodies[static_cast<std::size_t>(index)];
  return metric(body.getPosition()) +
         rotationBy(body.getAngle()) * (inverse(rotationBy(start.angle)) * (point - start.place));
}

Solid LiveScene::solidOf(std::size_t index) const {
  const HuntBody& body = *m_bodies[index];
  Solid solid;
  solid.centre = metric(body.getPosition());
  const auto rotation = rotationBy(body.getAngle());
  for (const naiad::physics::ConvexShape& shape : body.getShapes()) {
    SolidPart part;
    part.radius = shape.radius;
    for (int i = 0; i < shape.count; ++i)
      part.points.push_back(solid.centre + rotation * shape.vertices[static_cast<std::size_t>(i)]);
    solid.parts.push_back(std::move(part));
  }
  if (solid.parts.empty()) {  // the Object's box, which does not turn
    const df::Box box = body.getBox();
    const Vec2 lower = solid.centre + metric(box.getCorner());
    const Vec2 upper = lower + metric({box.width(), box.height()});
    solid.parts = {{{lower, {upper.x, lower.y}, upper, {lower.x, upper.y}}, 0}};
  }
  measure(solid);
  return solid;
}

Solid LiveScene::solidOf(const ObstacleData& obstacle) const {
  const Vec2 c = obstacle.centre, h = obstacle.half;
  Solid solid;
  solid.centre = c;
  solid.parts = {{{c - h, {c.x + h.x, c.y - h.y}, c + h, {c.x - h.x, c.y + h.y}}, 0}};
  measure(solid);
  return solid;
}

bool LiveScene::areJoined(int a, int b) const {
  for (std::size_t i = 0; i < m_joints.size(); ++i) {
    const JointData& data = m_now.joints[i];
    if (((data.a == a && data.b == b) || (data.a == b && data.b == a)) && m_joints[i].exists()) return true;
  }
  return false;
}

void LiveScene::recordSolids(Tick& tick) {
  const std::vector<Tick>& ticks = m_recording.ticks;
  const std::vector<BodyState>& before = ticks.size() > 1 ? ticks[ticks.size() - 2].bodies : tick.bodies;
  for (std::size_t i = 0; i < m_bodies.size(); ++i) {
    m_body_solids[i] = m_bodies[i] != nullptr ? solidOf(i) : Solid{};
    const BodyState &from = before[i], &to = tick.bodies[i];
    m_travels[i] = length(to.place - from.place) + length(from.velocity) + length(to.velocity) +
                   m_body_solids[i].reach * std::max(std::abs(from.spin), std::abs(to.spin));
  }
  for (std::size_t i = 0; i < m_obstacles.size(); ++i) {
    if (m_acted || ticks.size() == 1)
      m_obstacle_solids[i] = m_obstacles[i] != nullptr ? solidOf(m_now.obstacles[i]) : Solid{};
  }
  for (int i = 0; i < static_cast<int>(m_bodies.size()); ++i) {
    for (int j = i + 1; j < static_cast<int>(m_bodies.size()); ++j) recordPair(tick, i, j);
    for (int j = 0; j < static_cast<int>(m_obstacles.size()); ++j) recordPair(tick, i, obstacleNumber(j));
  }
}

void LiveScene::recordPair(Tick& tick, int a, int b) {
  const Solid *p_a = solidAt(a), *p_b = solidAt(b);
  if (p_a == nullptr || p_b == nullptr || solidnessOf(a) != df::HARD || solidnessOf(b) != df::HARD) return;
  const bool is_dynamic = m_now.bodies[static_cast<std::size_t>(a)].isDynamic();
  const bool is_other = b >= 0 && m_now.bodies[static_cast<std::size_t>(b)].isDynamic();
  if (!is_dynamic && !is_other) return;
  const double depth = depthOf(*p_a, *p_b);
  const auto found = std::find(m_excluded.begin(), m_excluded.end(), std::pair(a, b));
  if (depth <= 0 && found != m_excluded.end()) m_excluded.erase(found);
  if (depth <= 0 || found != m_excluded.end()) return;
  if ((m_displaces || m_recording.ticks.size() == 1) && depth > 1e-9) {
    m_excluded.emplace_back(a, b);
    if (!areJoined(a, b)) tick.displaced = m_displaced = true;
    return;
  }
  if (areJoined(a, b)) return;
  // Bodies that move fast overlap between a step's search and the next.
  const double travel = travelOf(a) + travelOf(b);
  const double unavoidable = (m_now.level == df::ACCURACY_FAST ? .25 : .05) * travel;
  const double thickness =
      std::min(is_dynamic ? p_a->thickness : p_b->thickness, is_other ? p_b->thickness : p_a->thickness);
  tick.depth = std::max(tick.depth, (depth - unavoidable) / thickness);
  tick.shift += depth;
}

void LiveScene::recordOpenings(Tick& tick) const {
  for (std::size_t i = 0; i < m_joints.size(); ++i) {
    const JointData& data = m_now.joints[i];
    using Kind = JointData::Kind;
    const bool has_length = data.kind == Kind::DISTANCE || data.kind == Kind::ROPE;
    const bool has_point = data.kind == Kind::HINGE || data.kind == Kind::WELD || data.kind == Kind::SLIDER;
    if ((!has_length && !has_point) || !m_joints[i].exists()) continue;
    const Vec2 between = anchorOf(data, true) - anchorOf(data, false);
    double opening = length(between);
    double lever = 0;
    if (has_length) {
      const double rest = data.length > 0 ? data.length : length(data.point_b - data.point_a);
      opening -= rest;
      if (data.kind == Kind::DISTANCE) opening = std::abs(opening);
      lever = rest;
    }
    if (data.kind == Kind::SLIDER) {
      Vec2 axis = data.axis / length(data.axis);
      if (const HuntBody* p_a = bodyAt(data.a); p_a != nullptr)
        axis = rotationBy(p_a->getAngle()) *
               (inverse(rotationBy(m_now.bodies[static_cast<std::size_t>(data.a)].angle)) * axis);
      opening = std::abs(cross(axis, between));
    }
    for (const int index : {data.a, data.b}) {
      if (index == kNothing) continue;
      const auto at = static_cast<std::size_t>(index);
      const Vec2 point = index == data.a ? data.point_a : data.point_b;
      lever = std::max({lever, m_body_solids[at].reach, length(point - m_now.bodies[at].place)});
    }
    // A sub-step of the fast level moves straight on, though the joint turns.
    const double turn = m_now.level == df::ACCURACY_FAST ? .25 * turnOf(data, lever) : 0;
    tick.opening = std::max(tick.opening, opening / lever - turn * turn);
    tick.shift += std::max(opening, 0.0);
  }
}

// Returns a bound of the angle by which the joint turns in this tick.
double LiveScene::turnOf(const JointData& joint, double lever) const {
  double turn = 0;
  const std::vector<Tick>& ticks = m_recording.ticks;
  for (std::size_t i = ticks.size() - std::min<std::size_t>(ticks.size(), 2); i < ticks.size(); ++i) {
    Vec2 velocity;
    for (const int index : {joint.a, joint.b}) {
      if (index == kNothing) continue;
      const BodyState& state = ticks[i].bodies[static_cast<std::size_t>(index)];
      turn = std::max(turn, std::abs(state.spin));
      velocity = state.velocity - velocity;
    }
    turn = std::max(turn, length(velocity) / lever);
  }
  return turn;
}

const Solid* LiveScene::solidAt(int number) const {
  if (number >= 0)
    return bodyAt(number) != nullptr ? &m_body_solids[static_cast<std::size_t>(number)] : nullptr;
  const auto index = static_cast<std::size_t>(obstacleNumber(number));
  return number != kNothing && m_obstacles[index] != nullptr ? &m_obstacle_solids[index] : nullptr;
}

df::Solidness LiveScene::solidnessOf(int number) const {
  return number >= 0 ? m_now.bodies[static_cast<std::size_t>(number)].solidness
                     : m_now.obstacles[static_cast<std::size_t>(obstacleNumber(number))].solidness;
}

// Returns a lower bound of the distance. To sensors, shapes may be boxes.
double LiveScene::gapOf(int a, int b) const {
  const Solid &one = *solidAt(a), &other = *solidAt(b);
  if (solidnessOf(a) == df::HARD && solidnessOf(b) == df::HARD) return -depthOf(one, other);
  const auto reachOf = [this](int number, const Solid& solid) {
    if (number >= 0) return Vec2{solid.reach, solid.reach};
    return m_now.obstacles[static_cast<std::size_t>(obstacleNumber(number))].half;
  };
  const Vec2 reach = reachOf(a, one) + reachOf(b, other), apart = one.centre - other.centre;
  return std::max(std::abs(apart.x) - reach.x, std::abs(apart.y) - reach.y);
}

// Completes the events of the tick with the least gap of the pair, and records which contacts are open.
void LiveScene::recordContacts(Tick& tick) {
  constexpr double kApart = .1;
  for (ContactEvent& event : m_recording.events) {
    if (event.tick != m_tick || m_acted) continue;
    const Solid *p_first = solidAt(event.first), *p_second = solidAt(event.second);
    if (p_first != nullptr && p_second != nullptr)
      event.gap = gapOf(event.first, event.second) - travelOf(event.first) - travelOf(event.second);
  }
  for (const ContactEvent& event : m_recording.events) {
    if (event.tick != m_tick) continue;
    std::erase_if(m_open, [&](const OpenContact& open) {
      return open.receiver == event.receiver && open.other == event.other();
    });
    if (event.begins && bodyAt(event.receiver) != nullptr && bodyAt(event.receiver)->hasContactEnds())
      m_open.push_back({event.receiver, event.other(), false});
  }
  std::erase_if(m_open, [this](const OpenContact& open) { return bodyAt(open.receiver) == nullptr; });
  for (OpenContact& open : m_open) {
    open.apart = solidAt(open.other) == nullptr || solidnessOf(open.receiver) == df::SPECTRAL ||
                 solidnessOf(open.other) == df::SPECTRAL || gapOf(open.receiver, open.other) > kApart;
  }
  tick.open = m_open;
}

}  // namespace

Recording run(const SceneData& scene, Detail detail, const std::vector<BodyState>* p_start) {
  return LiveScene(scene, detail, p_start, false).record();
}

std::string programOf(const SceneData& scene, const std::string& comment) {
  LiveScene live(scene, Detail::STATES, nullptr, true);
  live.record();
  return live.program(comment);
}

}  // namespace hunt
