// Builds the world of a LiveScene, and carries out its actions.
#include "LiveScene.h"

#include "engine/managers/WorldManager.h"
#include "engine/world/EventCollision.h"
#include "engine/world/WorldLog.h"
#include "physics/body/EventContactEnd.h"
#include "shared/math/Elementary.h"

namespace hunt {
namespace {

using df::Vector;

// Calls a function and writes the call. `target` is an expression that ends with . or ->, `before` its text.
#define CALL(before, target, function, ...) \
  (m_script.call(before, #function, __VA_ARGS__), target function(__VA_ARGS__))

std::string element(const char* list, std::size_t index) {
  return list + ("[" + std::to_string(index)) + "]";
}

df::Solidness chosenSolidness(const Action& action) {
  return static_cast<df::Solidness>(static_cast<int>(action.x));
}

}  // namespace

Vector HuntField::accelerationAt(Vector d, Vector v, double /*time*/) const {
  const double k = m_data.strength, c = m_data.steepness;
  if (m_data.kind == FieldData::Kind::LINEAR) return {-k * d.x(), -k * d.y()};
  if (m_data.kind == FieldData::Kind::MAGNET) return {-k * v.y(), k * v.x()};
  return {-k * df::math::tanh(c * d.x()), -k * df::math::tanh(c * d.y())};
}

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

Recording run(const SceneData& scene, Detail detail, const std::vector<BodyState>* p_start) {
  return LiveScene(scene, detail, p_start, false).record();
}

std::string programOf(const SceneData& scene, const std::string& comment) {
  LiveScene live(scene, Detail::STATES, nullptr, true);
  live.record();
  return live.program(comment);
}

}  // namespace hunt
