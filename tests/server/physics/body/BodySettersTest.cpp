// Setters on living contacts and joints: the world after the call moves like a world that was built that way.
#include <cstdlib>
#include <fstream>
#include <functional>
#include <regex>
#include <set>
#include <sstream>

#include "physics/body/Field.h"
#include "tests/server/physics/BodyScene.h"

namespace df::test {
namespace {

class BodySetters : public PhysicsWorld {};

// A scene of at most two dynamic bodies.
struct Scene {
  bool turning = false;
  std::vector<Body*> bodies;
  std::vector<Object*> obstacles;
  std::vector<Joint> joints;

  Body* add(Body* p_body) {
    if (turning) p_body->setTurning();
    bodies.push_back(p_body);
    return p_body;
  }
  Body* crate(double x, double y, double mass = 1) {
    return add(PhysicsWorld::crate(Vector(x, y), Vector(0.5, 0.5), mass));
  }
  Body* ball(double y) { return add(PhysicsWorld::ball(Vector(0, y), Vector(3, 0))); }
  void wall(double x, double y, double half_width) {
    obstacles.push_back(PhysicsWorld::wall(Vector(x, y), Vector(half_width, 5)));
  }
  Joint& add(Joint joint) { return joints.emplace_back(joint); }
};

struct Situation {
  const char* name;
  bool has_floor;
  void (*build)(Scene& s);
};

constexpr double kG = 0.01;
const Vector kOrigin(0, 0);

const Situation kSituations[] = {
    {"rest", true, [](Scene& s) { s.crate(0, -0.5); }},
    {"slope", true, [](Scene& s) { PM.setGravity(Vector(0.003, kG)), s.crate(0, -0.5); }},
    {"slide", true, [](Scene& s) { s.crate(0, -0.5)->setVelocity(Vector(0.3, 0)); }},
    {"stack", true, [](Scene& s) { s.crate(0, -0.5), s.crate(0.1, -1.5, 2); }},
    {"lift", false,
     [](Scene& s) {
       Body* p_lift = PhysicsWorld::crate(Vector(0, 0.5), Vector(4, 0.5));
       p_lift->setKinematic();
       p_lift->setVelocity(Vector(0.02, -0.01));
       s.crate(0, -0.5);
       s.bodies.push_back(p_lift);
     }},
    {"roll", true, [](Scene& s) { s.ball(-0.5)->setFriction(0.5), s.bodies[0]->setRestitution(0); }},
    {"bounce", true, [](Scene& s) { s.ball(-2)->setFriction(0.3); }},
    {"corner", true,
     [](Scene& s) { s.wall(1.5, -5, 1), PM.setGravity(Vector(0.008, kG)), s.crate(0, -0.5); }},
    {"meet", false,
     [](Scene& s) {
       PM.setGravity(Vector());
       s.crate(0, 0)->setVelocity(Vector(0.1, 0));
       s.crate(1.5, 0.2);
     }},
    {"sprung", true, [](Scene& s) { s.crate(0, -0.5)->setSpring(Vector(2, -0.5), 0.02, 0.05); }},
    {"hinge", false, [](Scene& s) { s.add(PM.addHinge(nullptr, s.crate(2, 0), kOrigin)); }},
    {"hung", false, [](Scene& s) { s.add(PM.addHinge(nullptr, s.crate(0, 2), kOrigin)); }},
    {"rods", false,
     [](Scene& s) {
       Body *p_a = s.crate(2, 0), *p_b = s.crate(4, 0);
       s.add(PM.addDistance(nullptr, p_a, kOrigin, Vector(2, 0)));
       s.add(PM.addDistance(p_a, p_b));
     }},
    {"rope", false, [](Scene& s) { s.add(PM.addRope(nullptr, s.crate(1, 1), kOrigin, Vector(1, 1))); }},
    {"weld", true,
     [](Scene& s) {
       Body *p_a = s.crate(0, -3.5), *p_b = s.crate(1, -3.5);
       s.add(PM.addWeld(p_a, p_b, Vector(0.5, -3.5)));
     }},
    {"slider", false, [](Scene& s) { s.add(PM.addSlider(nullptr, s.crate(0, 0), kOrigin, Vector(1, 0.5))); }},
    {"spring", false,
     [](Scene& s) {
       Body *p_a = s.crate(2, 0), *p_b = s.crate(5, 0);
       s.add(PM.addSpring(nullptr, p_a, kOrigin, Vector(2.2, 0.1), 0.1, 0.02));
       s.add(PM.addSpring(p_a, p_b, 0.2));
     }},
    {"motor", false,
     [](Scene& s) {
       s.add(PM.addMotor(nullptr, s.crate(0.5, 0), 0.05, 0.02));
       s.add(PM.addHinge(nullptr, s.bodies[0], kOrigin));
     }},
    {"limit", false,
     [](Scene& s) {
       s.add(PM.addAngleLimit(nullptr, s.crate(1, 0), -0.1, 0.4));
       s.add(PM.addHinge(nullptr, s.bodies[0], kOrigin));
     }},
    {"mouse", true,
     [](Scene& s) {
       s.add(PM.addMouse(s.crate(0, -0.5), Vector(0.3, -0.7), 0.05)).setTarget(Vector(1, -3));
     }},
    {"tow", true,
     [](Scene& s) {
       Body *p_a = s.crate(0, -0.5), *p_b = s.crate(3, -0.5);
       p_b->setVelocity(Vector(0.2, 0));
       s.add(PM.addRope(p_a, p_b));
     }},
};

struct Setter {
  const char* name;  // "Class::function"
  const char* value;
  std::function<void(Scene& scene, Body& body)> call;  // empty: it cannot change how bodies move
};

Joint jointOf(const Scene& s) {
  return s.joints.empty() ? Joint() : s.joints.back();
}
Object* obstacleOf(const Scene& s) {
  return s.obstacles.empty() ? nullptr : s.obstacles.front();
}
Body* otherThan(const Scene& s, const Body& body) {
  for (Body* p_other : s.bodies) {
    if (p_other != &body) return p_other;
  }
  return nullptr;
}

#define ON_BODY(value, ...)      \
  value, [](Scene& s, Body& b) { \
    (void)s, (void)b;            \
    __VA_ARGS__;                 \
  }
#define ON_OBSTACLE(value, ...)                   \
  value, [](Scene& s, Body&) {                    \
    if (Object* p_o = obstacleOf(s)) __VA_ARGS__; \
  }

const FieldOf kBreeze([](Vector d, Vector) { return Vector(0.004, -0.001) + Vector(-0.01 * d.x(), 0); });

const std::vector<Setter>& setters() {
  static const std::vector<Setter> kAll = {
      {"None", ON_BODY("")},
      {"Body::setMass", ON_BODY("0.2", b.setMass(0.2))},
      {"Body::setMass", ON_BODY("50", b.setMass(50))},
      {"Body::setGravityScale", ON_BODY("0", b.setGravityScale(0))},
      {"Body::setGravityScale", ON_BODY("-1", b.setGravityScale(-1))},
      {"Body::setGravityScale", ON_BODY("3", b.setGravityScale(3))},
      {"Body::setKinematic", ON_BODY("true", b.setKinematic())},
      {"Body::setKinematic", ON_BODY("false", b.setKinematic(false))},
      {"Body::setRestitution", ON_BODY("0", b.setRestitution(0))},
      {"Body::setRestitution", ON_BODY("0.7", b.setRestitution(0.7))},
      {"Body::setFriction", ON_BODY("0", b.setFriction(0))},
      {"Body::setFriction", ON_BODY("1e-12", b.setFriction(1e-12))},
      {"Body::setFriction", ON_BODY("0.05", b.setFriction(0.05))},
      {"Body::setFriction", ON_BODY("2", b.setFriction(2))},
      {"Body::setContactEnds", ON_BODY("", b.setContactEnds())},
      {"Body::setBoxShape", ON_BODY("", b.setBoxShape())},
      {"Body::setBoxShape", ON_BODY("0.6, 1", b.setBoxShape(0.6, 1))},
      {"Body::setCircle", ON_BODY("", b.setCircle(0.5))},
      {"Body::setPolygon",
       ON_BODY("", b.setPolygon({Vector(-0.5, 0.25), Vector(0.5, 0.25), Vector(0, -0.5)}))},
      {"Body::addCircle", ON_BODY("", b.addCircle(0.4, Vector(0.4, -0.4)))},
      {"Body::addBoxShape", ON_BODY("", b.addBoxShape(0.5, 0.5, Vector(0.6, -0.6), 0.3))},
      {"Body::addPolygon", ON_BODY("", b.addPolygon({Vector(0.5, 0), Vector(1.2, 0.2), Vector(0.5, 0.4)}))},
      {"Body::setTurning", ON_BODY("true", b.setTurning(true))},
      {"Body::setTurning", ON_BODY("false", b.setTurning(false))},
      {"Body::setAngle", ON_BODY("0.2", b.setAngle(b.getAngle() + 0.2))},
      {"Body::setSpin", ON_BODY("0.05", b.setSpin(0.05))},
      {"Body::setPosition", ON_BODY("up", b.setPosition(b.getPosition() + Vector(0.1, -0.3)))},
      {"Body::setPosition", ON_BODY("into", b.setPosition(b.getPosition() + Vector(0, 0.01)))},
      {"Body::setVelocity", ON_BODY("", b.setVelocity(Vector(-0.2, -0.05)))},
      {"Body::applyForce", ON_BODY("", b.applyForce(Vector(0.05, -0.005)))},
      {"Body::applyImpulse", ON_BODY("", b.applyImpulse(Vector(0.05, -0.01)))},
      {"Body::applyImpulseAt",
       ON_BODY("", b.applyImpulseAt(Vector(0.05, -0.01), b.getPosition() + Vector(0.2, 0.1)))},
      {"Body::applyTorque", ON_BODY("", b.applyTorque(0.01))},
      {"Body::setDrag", ON_BODY("linear", b.setDrag(0.1))},
      {"Body::setDrag", ON_BODY("quadratic", b.setDrag(0, 0.5))},
      {"Body::setSpring", ON_BODY("soft", b.setSpring(Vector(1, -1), 0.01, 0.01))},
      {"Body::setSpring", ON_BODY("stiff", b.setSpring(Vector(1, -1), 50, 1))},
      {"Body::setSpring", ON_BODY("none", b.setSpring(Vector(), 0))},
      {"Body::setField", ON_BODY("", b.setField(&kBreeze))},
      {"Body::setDrawing", ON_BODY("", b.setDrawing(BodyDrawing::FILL))},

      {"Object::setPosition", ON_BODY("body", b.Object::setPosition(b.getPosition() + Vector(0.125, -0.25)))},
      {"Object::setVelocity", ON_BODY("body", b.Object::setVelocity(Vector(0.125, -0.0625)))},
      {"Object::setSpeed", ON_BODY("body", b.setDirection(Vector(1, 0)); b.setSpeed(0.125))},
      {"Object::setDirection", ON_BODY("body", b.setDirection(Vector(0.125, -0.0625)))},
      {"Object::setXVelocity", ON_BODY("body", b.setXVelocity(0.125))},
      {"Object::setYVelocity", ON_BODY("body", b.setYVelocity(-0.125))},
      {"Object::setAcceleration", ON_BODY("body", b.setAcceleration(Vector(0.01, 0)))},
      {"Object::setBox", ON_BODY("body", b.setBox(Box(Vector(-0.5, -0.5), 1, 1)))},
      {"Object::setSolidness", ON_BODY("SOFT", b.setSolidness(SOFT))},
      {"Object::setSolidness", ON_BODY("SPECTRAL", b.setSolidness(SPECTRAL))},
      {"Object::setActive", ON_BODY("body", b.setActive(false))},
      {"Object::setPosition", ON_OBSTACLE("away", p_o->setPosition(p_o->getPosition() + Vector(0, 1)))},
      {"Object::setPosition", ON_OBSTACLE("aside", p_o->setPosition(p_o->getPosition() + Vector(50.25, 0)))},
      {"Object::setPosition", ON_OBSTACLE("into", p_o->setPosition(p_o->getPosition() + Vector(0, -0.01)))},
      {"Object::setVelocity", ON_OBSTACLE("", p_o->setVelocity(Vector(0.0625, 0.0625)))},
      {"Object::setAcceleration", ON_OBSTACLE("", p_o->setAcceleration(Vector(0, 0.0625)))},
      {"Object::setBox", ON_OBSTACLE("narrow", p_o->setBox(Box(Vector(-40, -5), 40.25, 10)))},
      {"Object::setBox", ON_OBSTACLE("lower", p_o->setBox(Box(Vector(-50, -4), 100, 9)))},
      {"Object::setSolidness", ON_OBSTACLE("SOFT", p_o->setSolidness(SOFT))},
      {"Object::setSolidness", ON_OBSTACLE("SPECTRAL", p_o->setSolidness(SPECTRAL))},
      {"Object::setActive", ON_OBSTACLE("", p_o->setActive(false))},

      {"PhysicsManager::setGravity", ON_BODY("none", PM.setGravity(Vector()))},
      {"PhysicsManager::setGravity", ON_BODY("up", PM.setGravity(Vector(0.002, -0.02)))},
      {"PhysicsManager::setGravity", ON_BODY("steep", PM.setGravity(Vector(0.02, 0.01)))},
      {"PhysicsManager::setAspect", ON_BODY("refused", PM.setAspect(2))},
      {"PhysicsManager::setIntegrator", ON_BODY("", PM.setIntegrator({}))},
      {"PhysicsManager::setObstacleFriction", ON_BODY("0", PM.setObstacleFriction(0))},
      {"PhysicsManager::setObstacleFriction", ON_BODY("0.1", PM.setObstacleFriction(0.1))},
      {"PhysicsManager::setObstacleFriction", ON_BODY("2", PM.setObstacleFriction(2))},
      {"PhysicsManager::setObstacleRestitution", ON_BODY("", PM.setObstacleRestitution(0.6))},
      {"PhysicsManager::setAccuracy",
       ON_BODY("other",
               PM.setAccuracy(PM.getAccuracy() == ACCURACY_FAST ? ACCURACY_DEFAULT : ACCURACY_FAST))},
      {"PhysicsManager::setSleeping", ON_BODY("false", PM.setSleeping(false))},
      {"PhysicsManager::setSleeping", ON_BODY("true", PM.setSleeping(true))},
      {"PhysicsManager::addDistance", ON_BODY("", PM.addDistance(nullptr, &b, b.getPosition() + Vector(3, 0),
                                                                 b.getPosition() + Vector(0.25, 0)))},
      {"PhysicsManager::addRope", ON_BODY("", if (Body* p = otherThan(s, b)) PM.addRope(p, &b))},
      {"PhysicsManager::addHinge",
       ON_BODY("world", PM.addHinge(nullptr, &b, b.getPosition() + Vector(1, -0.5)))},
      {"PhysicsManager::addHinge",
       ON_BODY("bodies", if (Body* p = otherThan(s, b)) PM.addHinge(p, &b, b.getPosition()))},
      {"PhysicsManager::addWeld",
       ON_BODY("", if (Body* p = otherThan(s, b)) PM.addWeld(p, &b, b.getPosition()))},
      {"PhysicsManager::addSlider", ON_BODY("", PM.addSlider(nullptr, &b, b.getPosition(), Vector(1, 0.2)))},
      {"PhysicsManager::addSpring",
       ON_BODY("", PM.addSpring(nullptr, &b, Vector(1, -4), b.getPosition(), 0.02, 0.01).setLength(1))},
      {"PhysicsManager::addMotor", ON_BODY("", PM.addMotor(nullptr, &b, 0.05, 0.01))},
      {"PhysicsManager::addAngleLimit", ON_BODY("", PM.addAngleLimit(nullptr, &b, -0.1, 0.1))},
      {"PhysicsManager::addMouse",
       ON_BODY("", PM.addMouse(&b, b.getPosition() + Vector(0.25, 0), 0.03).setTarget(Vector(2, -2)))},

      {"Joint::remove", ON_BODY("", jointOf(s).remove())},
      {"Joint::setBreakForce", ON_BODY("0.001", jointOf(s).setBreakForce(0.001))},
      {"Joint::setBreakForce", ON_BODY("1e6", jointOf(s).setBreakForce(1e6))},
      {"Joint::setBreakTorque", ON_BODY("1e-4", jointOf(s).setBreakTorque(1e-4))},
      {"Joint::setLength", ON_BODY("longer", jointOf(s).setLength(jointOf(s).getLength() + 0.25))},
      {"Joint::setLength", ON_BODY("shorter", jointOf(s).setLength(0.9 * jointOf(s).getLength()))},
      {"Joint::setStiffness", ON_BODY("soft", jointOf(s).setStiffness(0.01, 0))},
      {"Joint::setStiffness", ON_BODY("stiff", jointOf(s).setStiffness(20, 1))},
      {"Joint::setSpeed",
       ON_BODY("", jointOf(s).setSpeed(-0.1); if (!s.joints.empty()) s.joints[0].setSpeed(-0.1))},
      {"Joint::setStrength",
       ON_BODY("0", jointOf(s).setStrength(0); if (!s.joints.empty()) s.joints[0].setStrength(0))},
      {"Joint::setStrength",
       ON_BODY("", jointOf(s).setStrength(1); if (!s.joints.empty()) s.joints[0].setStrength(1))},
      {"Joint::setLimits", ON_BODY("", if (!s.joints.empty()) s.joints[0].setLimits(-0.2, 0.8))},
      {"Joint::setTarget", ON_BODY("", jointOf(s).setTarget(Vector(-1, -1)))},
  };
  return kAll;
}

double distanceOf(const Body* p_a, const Body* p_b) {
  double most = 0;
  const BodyBits a = stateBits(p_a), b = stateBits(p_b);
  for (std::size_t i = 0; i < a.size(); ++i) {
    double d = std::fabs(std::bit_cast<double>(a[i]) - std::bit_cast<double>(b[i]));
    if (i == 4 && d > 3) d = std::fabs(d - 6.283185307179586);
    most = std::max(most, d == d ? d : 1e300);
  }
  return most;
}

constexpr int kTicks = 30;

// A world with a scene.
class Trial {
 public:
  Trial(const Situation& situation, bool turning, bool fast) {
    if (fast) PM.setAccuracy(ACCURACY_FAST);
    scene.turning = turning;
    if (situation.has_floor) scene.wall(0, 5, 50);
    PM.setGravity(Vector(0, kG));
    situation.build(scene);
  }
  void ticks(int n) {
    for (int i = 0; i < n; ++i) own.world.update();
  }
  /// Gives its bodies and obstacles the places and motions of the other's.
  void copy(const Trial& other) {
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
      Body &to = *scene.bodies[i], &from = *other.scene.bodies[i];
      if (from.getAngle() != to.getAngle()) to.setAngle(from.getAngle());
      to.setPosition(from.getPosition());
      to.setVelocity(from.getVelocity());
      to.setSpin(from.getSpin());
    }
  }
  void set(const Setter& setter, std::size_t which) {
    const World::Scope scope(own.world);
    if (setter.call) setter.call(scene, *scene.bodies[which]);
  }

  OwnWorld own;
  Scene scene;
};

// Runs one case. Returns the largest difference of the two worlds; -1: there is no such case.
double compare(const Situation& situation, bool turning, bool fast, int before, const Setter& setter,
               std::size_t which) {
  Trial first(situation, turning, fast);
  if (which >= first.scene.bodies.size()) return -1;
  first.ticks(before);
  Trial second(situation, turning, fast);
  second.copy(first);
  first.set(setter, which);
  second.set(setter, which);
  double most = 0;
  for (int tick = 0; tick < kTicks; ++tick) {
    first.ticks(1);
    second.ticks(1);
    for (std::size_t i = 0; i < first.scene.bodies.size(); ++i)
      most = std::max(most, distanceOf(first.scene.bodies[i], second.scene.bodies[i]));
  }
  return most;
}

// Cases with a larger difference than the others, and its limit. Most are non-turning bodies, for which an
// ImpactWorld has no path under a force that changes within a tick, and lets overlapping bodies pass.
struct Exception {
  const char* situation;  // null: all
  const char* setter;
  bool fast, turning;
  double most;
};
constexpr Exception kExceptions[] = {
    {nullptr, "Body::setDrag", false, false, 0.001},
    {nullptr, "Body::setField", false, false, 0.002},
    {"rods", "PhysicsManager::addHinge", false, false, 0.001},
    {"rods", "PhysicsManager::addWeld", false, false, 0.001},
    {"sprung", "PhysicsManager::addSlider", false, false, 2e-06},
    {"stack", "Body::setPosition", false, false, 1},
    {"stack", "Object::setPosition", false, false, 1},
    {"corner", "Object::setAcceleration", false, true, 0.03},
    {"corner", "Object::setBox", false, true, 0.06},
    {"corner", "Object::setPosition", false, true, 0.06},
    {"meet", "Body::setField", false, true, 0.0003},
    {"meet", "Body::setSpring", false, true, 0.0002},
    {"meet", "PhysicsManager::addMotor", false, true, 4e-06},
    {"meet", "PhysicsManager::addMouse", false, true, 0.02},
    {"meet", "PhysicsManager::addSpring", false, true, 0.006},
    {"rods", "PhysicsManager::addHinge", false, true, 0.0002},
    {"rods", "PhysicsManager::addWeld", false, true, 2e-05},
    {"spring", "PhysicsManager::addSlider", false, true, 2e-05},
    {"sprung", "PhysicsManager::addSlider", false, true, 2e-06},
    {"stack", "Body::applyImpulse", false, true, 0.004},
    {"stack", "Body::setRestitution", false, true, 0.005},
    {"stack", "Body::setSpring", false, true, 5e-06},
    {"stack", "Object::setYVelocity", false, true, 0.0002},
    {"stack", "PhysicsManager::addSpring", false, true, 0.003},
    {"stack", "Object::setAcceleration", true, false, 0.07},
    {"stack", "PhysicsManager::setAccuracy", true, false, 0.2},
    {"sprung", "PhysicsManager::addMouse", true, true, 0.03},
    {"stack", "Object::setAcceleration", true, true, 0.03},
};

double limitOf(const Situation& situation, const Setter& setter, bool fast, bool turning) {
  for (const Exception& e : kExceptions) {
    const bool is_its = (e.situation == nullptr || std::string(e.situation) == situation.name) &&
                        std::string(e.setter) == setter.name && e.fast == fast && e.turning == turning;
    if (is_its) return e.most;
  }
  return fast ? 0.02 : 1e-6;
}

// The worlds are equal after each setter, in each situation, at both levels, awake and asleep. Tests every
// third case.
TEST_F(BodySetters, WorldIsAsIfBuiltThatWay) {
  constexpr int kStride = 3;
  int cases = 0;
  for (const Situation& situation : kSituations) {
    for (const Setter& setter : setters()) {
      for (int variant = 0; variant < 16; ++variant) {
        const bool fast = (variant & 1) != 0, turning = (variant & 2) != 0;
        const int before = (variant & 4) != 0 ? 45 : 7;
        if (++cases % kStride != 0 && std::getenv("ALL") == nullptr) continue;
        const double difference =
            compare(situation, turning, fast, before, setter, static_cast<std::size_t>(variant / 8));
        EXPECT_LE(difference, limitOf(situation, setter, fast, turning))
            << situation.name << ' ' << setter.name << '(' << setter.value << ')' << (fast ? " fast" : "")
            << (turning ? " turning" : "") << " after " << before << " ticks, body " << variant / 8;
      }
    }
  }
}

// Returns the names of the public functions of a header that change something: setX, addX, applyX, remove.
std::set<std::string> changersOf(const std::string& header) {
  std::ifstream file(std::string(NAIAD_SOURCE_DIR) + "/server/" + header);
  EXPECT_TRUE(file) << header;
  std::stringstream text;
  text << file.rdbuf();
  std::string code = std::regex_replace(text.str(), std::regex("//[^\n]*"), "");
  code = code.substr(0, code.find("\n private:"));
  std::set<std::string> names;
  const std::regex name("[ \\n]((?:set|add|apply)[A-Z][A-Za-z]*|remove)\\(");
  for (std::sregex_iterator at(code.begin(), code.end(), name), end; at != end; ++at) names.insert((*at)[1]);
  return names;
}

// The list above has each function of the public headers, so that none is forgotten.
TEST_F(BodySetters, ListHasEverySetterOfTheHeaders) {
  // They change only what is drawn, what the book's moves do, or what events an Object gets.
  const std::set<std::string> without_effect = {
      "setType",       "setId",        "setAltitude",     "setNoSoft",         "setSwept",
      "setPrecise",    "setMask",      "setRestContacts", "setMayMoveOut",     "setVisible",
      "setSprite",     "setAnimation", "setSpriteIndex",  "setSpriteSlowdown", "setSpriteSlowdownCount",
      "setSpriteName", "setCentered",  "setTransparency", "setShape",          "setStaticLook",
      "setModified",   "setPath",      "setFollowPath",   "setAvoidCollisions"};
  std::map<std::string, std::set<std::string>> listed;
  for (const Setter& setter : setters()) {
    const std::string name = setter.name;
    const std::size_t colon = name.find("::");
    if (colon != std::string::npos) listed[name.substr(0, colon)].insert(name.substr(colon + 2));
  }
  for (const auto& [class_name, header] : {std::pair{"Body", "physics/body/Body.h"},
                                           {"Joint", "physics/body/BodyJoint.h"},
                                           {"PhysicsManager", "physics/body/PhysicsManager.h"},
                                           {"Object", "engine/world/Object.h"}}) {
    const std::set<std::string> names = changersOf(header);
    EXPECT_GE(names.size(), 8u) << header;
    for (const std::string& name : names) {
      EXPECT_TRUE(listed[class_name].count(name) > 0 ||
                  (class_name == std::string("Object") && without_effect.count(name) > 0))
          << class_name << "::" << name;
    }
  }
}

}  // namespace
}  // namespace df::test
