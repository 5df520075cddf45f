#include "LiveScene.h"

#include "engine/managers/WorldManager.h"
#include "engine/world/EventCollision.h"
#include "engine/world/WorldLog.h"
#include "physics/body/EventContactEnd.h"
#include "shared/math/Elementary.h"

namespace hunt {
namespace {

using df::Vector;

constexpr const char* kBegin = R"(#include <cmath>
#include <cstdio>
#include <functional>
#include <map>
#include <vector>

#include "Body.h"
#include "EventCollision.h"
#include "EventContactEnd.h"
#include "Field.h"
#include "PhysicsManager.h"
#include "WorldManager.h"

using namespace df;

int tick = 0;
std::map<std::pair<int, int>, std::function<void()>> handlers;  // by body and number of its event
struct Traced;
std::map<int, Traced*> traced;

struct Traced : Body {
  explicit Traced(int its_index) : index(its_index) { traced[index] = this; }
  ~Traced() override { traced.erase(index); }
  int eventHandler(const Event* p_event) override {
    const bool begins = p_event->getType() == COLLISION_EVENT;
    if (!begins && p_event->getType() != CONTACT_END_EVENT) return 0;
    std::printf("tick %d: body %d: a contact %s\n", tick, index, begins ? "begins" : "ends");
    if (const auto found = handlers.find({index, events++}); found != handlers.end()) found->second();
    return 1;
  }
  int index, events = 0;
};

void update(int ticks) {
  while (ticks-- > 0) {
    WM.update();
    ++tick;
    for (const auto& [index, p_body] : traced) {
      const Vector place = p_body->getPosition(), velocity = p_body->getVelocity();
      std::printf("%d %d: %.9g %.9g  %.9g %.9g  %.9g %.9g\n", tick, index, place.x(), place.y(),
                  velocity.x(), velocity.y(), p_body->getAngle(), p_body->getSpin());
    }
  }
}

)";

// Calls a function and writes the call. `target` is an expression that ends with . or ->.
#define CALL(target, function, ...) \
  (m_script.call(m_on, #function, __VA_ARGS__), target function(__VA_ARGS__))

std::string element(const char* list, int index) {
  return list + ("[" + std::to_string(index)) + "]";
}

df::Solidness solidnessIn(const Action& action) {
  return static_cast<df::Solidness>(static_cast<int>(action.x));
}

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

std::string codeOf(const FieldData& field, int index) {
  const std::string k = Script::codeOf(field.strength), c = Script::codeOf(field.steepness);
  std::string result = "-" + k + " * d.x(), -" + k + " * d.y()";
  if (field.kind == FieldData::Kind::MAGNET) result = "-" + k + " * v.y(), " + k + " * v.x()";
  if (field.kind == FieldData::Kind::TANH)
    result = "-" + k + " * std::tanh(" + c + " * d.x()), -" + k + " * std::tanh(" + c + " * d.y())";
  return "struct : Field {\n  Vector accelerationAt([[maybe_unused]] Vector d, [[maybe_unused]] Vector v, "
         "double) const override {\n    return {" +
         result + "};\n  }\n} field" + std::to_string(index) + ";\n\n";
}

}  // namespace

int HuntBody::eventHandler(const df::Event* p_event) {
  m_scene.onContact(m_index, p_event);
  return 1;
}

LiveScene::LiveScene(const SceneData& scene, const std::vector<BodyState>* p_start, bool writes)
    : m_now(scene),
      m_script(writes),
      m_bodies(scene.bodies.size()),
      m_obstacles(scene.obstacles.size()),
      m_joints(scene.joints.size()),
      m_on("PM."),
      m_event_counts(scene.bodies.size()) {
  m_world.log().setSink([](const std::string&) {});
  CALL(PM., setAspect, scene.aspect);
  CALL(PM., setGravity, cells(scene.gravity));
  CALL(PM., setObstacleFriction, scene.obstacle_friction);
  CALL(PM., setObstacleRestitution, scene.obstacle_restitution);
  CALL(PM., setAccuracy, scene.level);
  CALL(PM., setSleeping, scene.sleeping);
  for (const FieldData& field : scene.fields) m_fields.push_back(std::make_unique<HuntField>(field));
  for (const int group : {int{scene.later_groups_first}, int{!scene.later_groups_first}}) {
    const auto addAll = [&](const auto& list, auto groupOf, void (LiveScene::*add)(int)) {
      for (std::size_t i = 0; i < list.size(); ++i) {
        if (list[i].present && groupOf(list[i]) == group) (this->*add)(static_cast<int>(i));
      }
    };
    const auto itsGroup = [](const BodyData& its) { return its.group; };
    addAll(m_now.obstacles, itsGroup, &LiveScene::addObstacle);
    addAll(m_now.bodies, itsGroup, &LiveScene::addBody);
    addAll(
        m_now.joints, [&](const auto& its) { return m_now.groupOf(its); }, &LiveScene::addJoint);
  }
  for (int i = 0; p_start != nullptr && i < static_cast<int>(p_start->size()); ++i) {
    HuntBody* p_body = bodyAt(i);
    const BodyState& state = at(*p_start, i);
    if (p_body == nullptr || !state.present) continue;
    p_body->setPosition(cells(state.place));
    p_body->setVelocity(cells(state.velocity));
    p_body->setAngle(state.angle);
    p_body->setSpin(state.spin);
  }
}

void LiveScene::addBody(int index) {
  const BodyData& data = at(m_now.bodies, index);
  auto* p_body = new HuntBody(*this, index);
  at(m_bodies, index) = p_body->key();
  m_numbers[p_body] = index;
  m_script.add(p_body->code() + " = new Traced(" + std::to_string(index) + ");");
  m_on = p_body->code() + "->";
  for (std::size_t i = 0; i < data.parts.size(); ++i) addPart(*p_body, data.parts[i], i == 0);
  CALL(p_body->, setPosition, cells(data.place));
  CALL(p_body->, setVelocity, cells(data.velocity));
  CALL(p_body->, setAngle, data.angle);
  CALL(p_body->, setSpin, data.spin);
  CALL(p_body->, setMass, data.mass);
  CALL(p_body->, setRestitution, data.restitution);
  CALL(p_body->, setFriction, data.friction);
  CALL(p_body->, setTurning, data.turning);
  if (data.kinematic) CALL(p_body->, setKinematic, true);
  if (data.solidness != df::HARD) CALL(p_body->, setSolidness, data.solidness);
  if (data.contact_ends) CALL(p_body->, setContactEnds, true);
  if (data.gravity_scale != 1) CALL(p_body->, setGravityScale, data.gravity_scale);
  if (data.linear_drag != 0 || data.quadratic_drag != 0)
    CALL(p_body->, setDrag, data.linear_drag, data.quadratic_drag);
  if (data.stiffness != 0 || data.damping != 0)
    CALL(p_body->, setSpring, cells(data.anchor), data.stiffness, data.damping);
  if (data.field == kNothing) return;
  m_script.call(m_on, "setField", Code{"&field" + std::to_string(data.field)}, cells(data.field_origin));
  p_body->setField(at(m_fields, data.field).get(), cells(data.field_origin));
}

void LiveScene::addPart(HuntBody& body, const Part& part, bool is_first) {
  const Vector size = cells(part.size), centre = cells(part.centre);
  std::vector<Vector> corners;
  for (const Vec2 corner : part.corners) corners.push_back(cells(corner));
  if (part.kind == Part::Kind::POLYGON) CALL(body., setPolygon, corners);
  if (part.kind == Part::Kind::CIRCLE && is_first) CALL(body., setCircle, part.size.x);
  if (part.kind == Part::Kind::CIRCLE && !is_first) CALL(body., addCircle, part.size.x, centre);
  if (part.kind == Part::Kind::BOX && is_first) CALL(body., setBoxShape, size.x(), size.y());
  if (part.kind == Part::Kind::BOX && !is_first)
    CALL(body., addBoxShape, size.x(), size.y(), centre, part.angle);
}

void LiveScene::addObstacle(int index) {
  const BodyData& data = at(m_now.obstacles, index);
  auto* p_obstacle = new df::Object;
  at(m_obstacles, index) = p_obstacle->key();
  m_numbers[p_obstacle] = obstacleNumber(index);
  m_script.add(element("obstacles", index) + " = new Object;");
  m_on = element("obstacles", index) + "->";
  const Vector half = cells(data.half());
  CALL(p_obstacle->, setBox, df::Box(Vector(-half.x(), -half.y()), 2 * half.x(), 2 * half.y()));
  CALL(p_obstacle->, setPosition, cells(data.place));
  if (data.solidness != df::HARD) CALL(p_obstacle->, setSolidness, data.solidness);
}

void LiveScene::addJoint(int index) {
  JointData& data = at(m_now.joints, index);
  HuntBody *p_a = bodyAt(data.a), *p_b = bodyAt(data.b);
  if ((p_a == nullptr && data.a != kNothing) || (p_b == nullptr && data.b != kNothing)) return;
  const Vector a = cells(data.point_a), b = cells(data.point_b);
  df::Joint& joint = at(m_joints, index);
  using Kind = JointData::Kind;
  m_on = element("joints", index) + " = PM.";
  if (data.kind == Kind::DISTANCE) joint = CALL(PM., addDistance, p_a, p_b, a, b);
  if (data.kind == Kind::ROPE) joint = CALL(PM., addRope, p_a, p_b, a, b);
  if (data.kind == Kind::HINGE) joint = CALL(PM., addHinge, p_a, p_b, a);
  if (data.kind == Kind::WELD) joint = CALL(PM., addWeld, p_a, p_b, a);
  if (data.kind == Kind::SLIDER) joint = CALL(PM., addSlider, p_a, p_b, a, cells(data.axis));
  if (data.kind == Kind::SPRING) joint = CALL(PM., addSpring, p_a, p_b, a, b, data.first, data.second);
  if (data.kind == Kind::MOTOR) joint = CALL(PM., addMotor, p_a, p_b, data.first, data.second);
  if (data.kind == Kind::LIMIT) joint = CALL(PM., addAngleLimit, p_a, p_b, data.first, data.second);
  if (data.kind == Kind::MOUSE) joint = CALL(PM., addMouse, p_b, b, data.first);
  m_on = element("joints", index) + ".";
  if (data.kind == Kind::MOUSE) {
    if (data.second == 0) data.second = p_b->getMass();
    CALL(joint., setStiffness, data.second, 2 * data.second);
    CALL(joint., setTarget, cells(data.target));
  }
  if (data.length > 0) CALL(joint., setLength, data.length);
  if (data.break_force > 0) CALL(joint., setBreakForce, data.break_force);
}

void LiveScene::update() {
  ++m_tick;
  m_acted = m_displaces = false;
  for (Action& action : m_now.actions) {
    if (action.present && action.when == Action::When::TICK && action.tick == m_tick) act(action);
  }
  m_script.update();
  m_world.update();
}

void LiveScene::onContact(int receiver, const df::Event* p_event) {
  const bool begins = p_event->getType() == df::COLLISION_EVENT;
  if (!begins && p_event->getType() != df::CONTACT_END_EVENT) return;
  const auto add = [&](const auto& event) {
    const auto numberOf = [this](const df::Object* p_object) {
      const auto found = m_numbers.find(p_object);
      return found == m_numbers.end() ? kNothing : found->second;
    };
    m_events.push_back(
        {m_tick, begins, receiver, numberOf(event.getObject1()), numberOf(event.getObject2())});
  };
  if (begins) add(*static_cast<const df::EventCollision*>(p_event));
  if (!begins) add(*static_cast<const df::EventContactEnd*>(p_event));
  const int count = at(m_event_counts, receiver)++;
  for (Action& action : m_now.actions) {
    const auto when = begins ? Action::When::BEGIN : Action::When::END;
    if (!action.present || action.when != when || action.receiver != receiver || action.tick > m_tick)
      continue;
    if (action.is("delete") && action.target == receiver)
      action.p_setter = &setterNamed("mark");  // a handler of the body itself is running
    m_script.beginHandler(receiver, count);
    act(action);
    m_script.endHandler();
    return;
  }
}

void LiveScene::act(Action& action) {
  action.present = false;
  const int target = action.target;
  switch (action.p_setter->target) {
    case TargetKind::BODY:
      if (bodyAt(target) == nullptr) return;
      m_on = element("bodies", target) + "->";
      actOnBody(action, *bodyAt(target), at(m_now.bodies, target));
      break;
    case TargetKind::OBSTACLE:
      if (obstacleAt(target) == nullptr) return;
      m_on = element("obstacles", target) + "->";
      actOnObstacle(action, *obstacleAt(target), at(m_now.obstacles, target));
      break;
    case TargetKind::JOINT:
      if (!at(m_joints, target).exists()) return;
      m_on = element("joints", target) + ".";
      actOnJoint(action, at(m_joints, target), at(m_now.joints, target));
      break;
    case TargetKind::WORLD:
      m_on = "PM.";
      actOnWorld(action);
      break;
  }
  m_acted = true;
  m_displaces = m_displaces || action.p_setter->displaces;
  m_displaced = m_displaced || m_displaces;
}

void LiveScene::actOnBody(const Action& action, HuntBody& body, BodyData& data) {
  const std::string_view name = action.p_setter->name;
  const Vector value = cells({action.x, action.y}), place = body.getPosition();
  const double x = action.x, y = action.y;
  if (name == "mass") CALL(body., setMass, data.mass = x);
  if (name == "restitution") CALL(body., setRestitution, data.restitution = x);
  if (name == "friction") CALL(body., setFriction, data.friction = x);
  if (name == "turning") CALL(body., setTurning, data.turning = x != 0);
  if (name == "kinematic") CALL(body., setKinematic, data.kinematic = x != 0);
  if (name == "solidness") CALL(body., setSolidness, data.solidness = solidnessIn(action));
  if (name == "velocity") CALL(body., setVelocity, value);
  if (name == "spin") CALL(body., setSpin, x);
  if (name == "position") CALL(body., setPosition, place + value);
  if (name == "angle") CALL(body., setAngle, x);
  if (name == "gravity scale") CALL(body., setGravityScale, data.gravity_scale = x);
  if (name == "drag") CALL(body., setDrag, data.linear_drag = x, data.quadratic_drag = 0);
  if (name == "impulse") CALL(body., applyImpulse, value);
  if (name == "force") CALL(body., applyForce, value);
  if (name == "spring") {
    data.anchor = metric(place);
    CALL(body., setSpring, place, data.stiffness = x, data.damping = y);
  }
  if (name == "circle" || name == "box") {
    data.parts = {{.kind = name == "box" ? Part::Kind::BOX : Part::Kind::CIRCLE, .size = {x, y}}};
    addPart(body, data.parts[0], true);
  }
  if (name == "mark" || name == "delete") data.present = false;
  if (name == "mark") {
    m_script.add("WM.markForDelete(" + body.code() + ");");
    WM.markForDelete(&body);
  } else if (name == "delete") {
    m_script.add("delete " + body.code() + ";");
    delete &body;
  }
}

void LiveScene::actOnObstacle(const Action& action, df::Object& obstacle, BodyData& data) {
  if (action.is("move obstacle")) {
    data.place += {action.x, action.y};
    CALL(obstacle., setPosition, cells(data.place));
  } else if (action.is("change obstacle")) {
    CALL(obstacle., setSolidness, data.solidness = solidnessIn(action));
  } else {
    data.present = false;
    m_script.add("delete " + element("obstacles", action.target) + ";");
    delete &obstacle;
  }
}

void LiveScene::actOnJoint(const Action& action, df::Joint& joint, JointData& data) {
  const std::string_view name = action.p_setter->name;
  const bool is_mouse = data.kind == JointData::Kind::MOUSE;
  const double x = action.x, y = action.y;
  if (name == "remove joint") {
    data.present = false;
    m_script.add(m_on + "remove();");
    joint.remove();
  }
  if (name == "length" && CALL(joint., setLength, x) == 0) data.length = x;
  if ((name == "stiffness" && !is_mouse && CALL(joint., setStiffness, x, y) == 0) ||
      (name == "limits" && CALL(joint., setLimits, y, x) == 0)) {
    data.first = name == "limits" ? y : x;
    data.second = name == "limits" ? x : y;
  }
  if (name == "speed" && CALL(joint., setSpeed, x) == 0) data.first = x;
  if (name == "strength" && CALL(joint., setStrength, x) == 0) (is_mouse ? data.first : data.second) = x;
  const Vec2 target = data.point_b + Vec2{x, y};
  if (name == "target" && CALL(joint., setTarget, cells(target)) == 0) data.target = target;
}

void LiveScene::actOnWorld(const Action& action) {
  const std::string_view name = action.p_setter->name;
  if (name == "gravity") CALL(PM., setGravity, cells(m_now.gravity = {0, action.y}));
  if (name == "all friction") CALL(PM., setObstacleFriction, m_now.obstacle_friction = action.x);
  if (name == "all restitution") CALL(PM., setObstacleRestitution, m_now.obstacle_restitution = action.x);
  const df::Accuracy level = action.x != 0 ? df::ACCURACY_FAST : df::ACCURACY_DEFAULT;
  if (name == "level") CALL(PM., setAccuracy, m_now.level = level);
  if (name == "sleeping") CALL(PM., setSleeping, m_now.sleeping = action.x != 0);
}

std::string LiveScene::program(const std::string& comment) {
  std::string fields;
  for (int i = 0; i < static_cast<int>(m_now.fields.size()); ++i) fields += codeOf(at(m_now.fields, i), i);
  const auto list = [](const char* type, const char* name, std::size_t size) {
    return std::string("  std::vector<") + type + "> " + name + "(" + std::to_string(size) + ");\n";
  };
  return "// " + comment + "\n" + kBegin + fields + "int main() {\n" +
         list("Traced*", "bodies", m_bodies.size()) + list("Object*", "obstacles", m_obstacles.size()) +
         list("Joint", "joints", m_joints.size()) + m_script.handlersAndSteps() + "}\n";
}

std::string programOf(const SceneData& scene, const std::string& comment) {
  LiveScene live(scene, nullptr, true);
  for (int i = 0; i < scene.ticks; ++i) live.update();
  return live.program(comment);
}

}  // namespace hunt
