#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "Simulation.h"
#include "engine/managers/WorldManager.h"
#include "engine/world/Object.h"
#include "engine/world/World.h"
#include "engine/world/WorldLog.h"
#include "physics/body/Body.h"

namespace bench::physics {
namespace {

constexpr double kTicks = Scene::kTicksPerSecond;
constexpr double kWorldSide = 1e6;  // side of the world in cells, so large that nothing leaves it

void demand(bool holds, const char* what) {
  if (!holds) throw std::runtime_error(std::string("a scene of bodies: ") + what);
}

class NaiadSimulation : public Simulation {
 public:
  NaiadSimulation(const Scene& scene, df::Accuracy accuracy) {
    m_world.log().setSink([](const std::string& /*line*/) {});
    const df::World::Scope scope(m_world);
    WM.setBoundary(df::Box(df::Vector(-kWorldSide / 2, -kWorldSide / 2), kWorldSide, kWorldSide));
    PM.setAspect(1);
    PM.setGravity(df::Vector(0, scene.gravity / (kTicks * kTicks)));
    PM.setObstacleFriction(Scene::kFriction);
    PM.setAccuracy(accuracy);
    PM.setSleeping(scene.sleep);
    m_things.reserve(scene.bodies.size());
    for (const Body& body : scene.bodies) add(body, scene.collide);
    for (const Hinge& hinge : scene.hinges) add(hinge);
    demand(m_world.log().refusals() == 0, "something was refused");
  }
  ~NaiadSimulation() override { m_world.shutDown(); }

  void tick() override { m_world.update(); }

  Pose pose(std::size_t body) const override {
    const Thing& thing = m_things[body];
    if (thing.p_body == nullptr) {
      const df::Vector position = thing.p_wall->getPosition();
      return {position.x(), position.y()};
    }
    const df::Vector position = thing.p_body->getPosition();
    const double angle = thing.p_body->getAngle();
    return {position.x(), position.y(), std::cos(angle), std::sin(angle)};
  }

  bool isFrozen(std::size_t body) const override {
    const df::Body* p_body = m_things[body].p_body;
    return p_body != nullptr && p_body->isFrozen();
  }

 private:
  // An object of the scene. One of the two pointers is set; the world owns the object.
  struct Thing {
    df::Body* p_body = nullptr;
    df::Object* p_wall = nullptr;
  };

  void add(const Body& body, bool collide) {
    // If nothing collides, a static body may have hinges, which only a df::Body can have.
    if (body.motion == Motion::STATIC && collide) {
      addWall(body);
    } else {
      addBody(body, collide);
    }
  }

  void addWall(const Body& body) {
    const Part& part = body.parts.front();
    auto* p_wall = new df::Object;
    const df::Vector corner(part.x - part.half_width, part.y - part.half_height);
    p_wall->setBox(df::Box(corner, 2 * part.half_width, 2 * part.half_height));
    p_wall->setPosition(df::Vector(body.x, body.y));
    demand(p_wall->getPosition() == df::Vector(body.x, body.y) && p_wall->getBox().getCorner() == corner &&
               p_wall->getBox().getHorizontal() == 2 * part.half_width &&
               p_wall->getBox().getVertical() == 2 * part.half_height,
           "a wall is rounded");
    m_things.push_back({.p_wall = p_wall});
  }

  void addBody(const Body& body, bool collide) {
    auto* p_body = new df::Body;
    if (!collide) p_body->setSolidness(df::SPECTRAL);
    addShapes(*p_body, body.parts);
    p_body->setPosition(df::Vector(body.x, body.y));
    p_body->setMass(body.mass());
    p_body->setFriction(Scene::kFriction);
    p_body->setTurning();
    p_body->setVelocity(df::Vector(body.vx / kTicks, body.vy / kTicks));
    p_body->setSpin(body.spin / kTicks);
    p_body->setKinematic(body.motion != Motion::DYNAMIC);
    m_things.push_back({.p_body = p_body});
  }

  // Adds parts. Their centres are relative to the mass centre of the parts added so far; in a scene, to that
  // of the whole body.
  static void addShapes(df::Body& made, const std::vector<Part>& parts) {
    double area = 0;
    double x = 0;
    double y = 0;
    for (const Part& part : parts) {
      const bool first = area == 0;
      const df::Vector centre(part.x - x, part.y - y);
      if (part.isCircle()) {
        first ? made.setCircle(part.radius) : made.addCircle(part.radius, centre);
      } else if (first) {
        made.setBoxShape(2 * part.half_width, 2 * part.half_height);
      } else {
        made.addBoxShape(2 * part.half_width, 2 * part.half_height, centre);
      }
      const double share = part.area() / (area + part.area());
      x += share * (part.x - x);
      y += share * (part.y - y);
      area += part.area();
    }
    demandShapes(made, parts);
  }

  static void demandShapes(const df::Body& made, const std::vector<Part>& parts) {
    constexpr double kRounding = 1e-12;
    const auto& shapes = made.getShapes();
    demand(shapes.size() == parts.size(), "shapes are missing");
    for (std::size_t i = 0; i < parts.size(); ++i) {
      double x = 0;
      double y = 0;
      for (int k = 0; k < shapes[i].count; ++k) {
        const auto& vertex = shapes[i].vertices[static_cast<std::size_t>(k)];
        x += vertex.x / shapes[i].count;
        y += vertex.y / shapes[i].count;
      }
      demand(std::abs(x - parts[i].x) + std::abs(y - parts[i].y) < kRounding, "a shape is elsewhere");
    }
  }

  void add(const Hinge& hinge) {
    const auto bodyOf = [&](int index) {
      return index == Hinge::kWorld ? nullptr : m_things[static_cast<std::size_t>(index)].p_body;
    };
    const df::Joint joint = PM.addHinge(bodyOf(hinge.a), bodyOf(hinge.b), df::Vector(hinge.x, hinge.y));
    demand(joint.exists(), "a hinge was refused");
  }

  df::World m_world;
  std::vector<Thing> m_things;
};

}  // namespace

SimulationPtr makeNaiad(const Scene& scene, df::Accuracy accuracy) {
  return std::make_unique<NaiadSimulation>(scene, accuracy);
}

}  // namespace bench::physics
