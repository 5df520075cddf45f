// Naiad's rigid bodies in the laboratory's scenes. Lengths in metres, time in ticks of 1/30 s.
#include <vector>

#include "ContactScene.h"
#include "physics/rigid/RigidWorld.h"

namespace lab {
namespace {

namespace physics = naiad::physics;

physics::Vec2 down(Vec v) {
  return {v.x, -v.y};
}

physics::RigidOptions optionsFor(const Scene& scene, int substeps) {
  physics::RigidOptions options;
  options.substeps = substeps;
  options.may_sleep = scene.may_sleep;
  return options;
}

class Rigid : public Simulation {
 public:
  explicit Rigid(const Scene& scene) : m_scene(scene) {}

  static bool canExpress(const Scene& scene) {
    if (!scene.rigid() || scene.field || !scene.joints.empty() || !scene.collides || scene.tick != kTick)
      return false;
    for (const Body& body : scene.bodies) {
      if (body.shapes.empty() || body.linear_drag != 0) return false;
    }
    return true;
  }

  void step(double, int substeps) override {
    if (!m_is_made) make(substeps);
    m_world.step();
    for (const physics::RigidEvent& event : m_world.events()) m_begun += event.is_begin ? 1 : 0;
  }

  BodyState body(int index) const override {
    if (!m_is_made) {
      const Body& b = m_scene.bodies[static_cast<std::size_t>(index)];
      return {b.position, b.velocity, b.angle, b.spin};
    }
    const physics::RigidBody& b = m_world.body(index);
    const physics::Vec2 at = b.place - m_origin;
    return {{at.x, -at.y},
            {b.velocity.x / kTick, -b.velocity.y / kTick},
            -physics::angleOf(b.rotation),
            -b.spin / kTick};
  }
  long contacts() const override { return m_begun; }

 private:
  // Creates the world. Called in the first step, because the number of sub-steps is unknown before.
  void make(int substeps) {
    m_is_made = true;
    m_world = physics::RigidWorld(optionsFor(m_scene, substeps));
    m_origin = physics::placeAt(down(m_scene.origin));
    for (const Body& body : m_scene.bodies) {
      std::vector<physics::ConvexShape> shapes;
      const double inertia = addShapes(body, -1, shapes);
      physics::RigidBody rigid;
      rigid.place = m_origin + down(body.position);
      rigid.velocity = kTick * down(body.velocity);
      rigid.rotation = physics::rotationBy(-body.angle);
      rigid.spin = -kTick * body.spin;
      const bool is_pushed = body.motion == Motion::DYNAMIC;
      rigid.inverse_mass = is_pushed ? 1 / body.mass : 0;
      rigid.inverse_inertia = is_pushed && body.rotates ? 1 / (body.mass * inertia) : 0;
      if (is_pushed) rigid.acceleration = kTick * kTick * down(m_scene.gravity);
      rigid.friction = body.friction;
      rigid.restitution = body.restitution;
      m_world.add(rigid, shapes);
    }
  }

  Scene m_scene;
  physics::Place m_origin;
  physics::RigidWorld m_world;
  long m_begun = 0;
  bool m_is_made = false;
};

const RegisteredMethod method({"rigid", "rigid solver alone", "1", Method::Kind::CANDIDATE,
                               [](const Scene& scene) -> SimulationPtr {
                                 return Rigid::canExpress(scene) ? std::make_unique<Rigid>(scene) : nullptr;
                               }});

}  // namespace
}  // namespace lab
