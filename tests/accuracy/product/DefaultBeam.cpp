// A df::Beam that is clamped at its left end; what pulls at the other is applied in each tick, as a game
// does. A metre is a cell, a tick of the scene is a tick, mass is in kg.
#include <cmath>
#include <memory>

#include "Default.h"
#include "engine/managers/WorldManager.h"
#include "engine/world/World.h"
#include "engine/world/WorldLog.h"
#include "physics/body/PhysicsManager.h"
#include "physics/body/SoftObject.h"

namespace lab {

namespace {

class DefaultBeam : public Simulation {
 public:
  explicit DefaultBeam(const Scene& scene) : m_tick(scene.tick) {
    m_world.log().setSink([](const std::string&) {});
    const df::World::Scope scope(m_world);
    PM.setAspect(1);
    PM.setGravity({m_tick * m_tick * scene.gravity.x, m_tick * m_tick * scene.gravity.y});
    const Beam& beam = scene.beams[0];
    const double mass = beam.density * beam.thickness * beam.length;
    const double ei = beam.modulus * std::pow(beam.thickness, 3) / 12;
    const double stiffness = 8 * ei / (mass * beam.length * beam.length);  // m/s²
    m_beam = std::make_unique<df::Beam>(df::Vector(0, 0), df::Vector(beam.length, 0), mass,
                                        m_tick * m_tick * stiffness, true, beam.elements);
    constexpr double kFirstRoot = 1.8751040687119612;  // of cos β cosh β = −1
    const double first = kFirstRoot * kFirstRoot * std::sqrt(ei / (mass * std::pow(beam.length, 3)));
    m_beam->setDrag(2 * beam.damping * first * m_tick);
    m_force = {0, -m_tick * m_tick * beam.tip_force};
  }
  ~DefaultBeam() override {
    const df::World::Scope scope(m_world);
    m_beam.reset();
  }
  DefaultBeam(const DefaultBeam&) = delete;
  DefaultBeam& operator=(const DefaultBeam&) = delete;

  void step(double /*tick*/, int /*substeps*/) override {
    m_beam->applyForce(freeEnd(), m_force);
    m_world.update();
  }
  std::optional<Work> work() const override { return Work{}; }

  BodyState body(int /*index*/) const override {
    const df::Vector position = m_beam->getNodePosition(freeEnd());
    const df::Vector velocity = m_beam->getNodeVelocity(freeEnd());
    BodyState state;
    state.position = {position.x(), position.y()};
    state.velocity = {velocity.x() / m_tick, velocity.y() / m_tick};
    return state;
  }

 private:
  int freeEnd() const { return m_beam->getNodeCount() - 1; }

  df::World m_world;
  double m_tick;
  df::Vector m_force;
  std::unique_ptr<df::Beam> m_beam;
};

}  // namespace

SimulationPtr beamByDefault(const Scene& scene) {
  if (scene.beams.size() != 1 || !scene.bodies.empty()) return nullptr;
  return std::make_unique<DefaultBeam>(scene);
}

}  // namespace lab
