// A df::Cloth that hangs by its upper corners, and a df::Beam that is clamped at its left end. The force at
// the other end is applied in each tick, like in a game. Mass is in kg.
#include <cmath>

#include "Default.h"
#include "ProductWorld.h"
#include "physics/body/SoftObject.h"

namespace lab {
namespace {

// Here y points down, and in the scene up.
class DefaultCloth : public ProductWorld {
 public:
  explicit DefaultCloth(const Scene& scene) : ProductWorld(scene), m_corner(scene.bodies.front().position) {
    const df::World::Scope scope(m_world);
    PM.setAspect(1);
    PM.setGravity({0, -m_tick * m_tick * scene.gravity.y});
    PM.setSleeping(scene.may_sleep);
    const Cloth& cloth = scene.cloths.front();
    m_p_cloth =
        &make<df::Cloth>(df::Vector(0, 0), cloth.mesh * (cloth.columns - 1), cloth.mesh * (cloth.rows - 1),
                         cloth.mass, m_tick * m_tick * cloth.stiffness, cloth.columns, cloth.rows);
    m_p_cloth->pin(m_p_cloth->getNode(0, 0));
    m_p_cloth->pin(m_p_cloth->getNode(cloth.columns - 1, 0));
  }

  BodyState body(int index) const override {
    const int columns = m_p_cloth->getColumns();
    const int node = m_p_cloth->getNode(index % columns, index / columns);
    BodyState state = stateOf(m_p_cloth->getNodePosition(node), m_p_cloth->getNodeVelocity(node));
    state.position = {m_corner.x + state.position.x, m_corner.y - state.position.y};
    state.velocity.y = -state.velocity.y;
    return state;
  }
  long frozen() const override { return m_p_cloth->isFrozen() ? 1 : 0; }

 private:
  Vec m_corner;
  df::Cloth* m_p_cloth = nullptr;
};

class DefaultBeam : public ProductWorld {
 public:
  explicit DefaultBeam(const Scene& scene) : ProductWorld(scene) {
    const df::World::Scope scope(m_world);
    PM.setAspect(1);
    PM.setGravity({m_tick * m_tick * scene.gravity.x, m_tick * m_tick * scene.gravity.y});
    const Beam& beam = scene.beams[0];
    const double mass = beam.density * beam.thickness * beam.length;
    const double ei = beam.modulus * std::pow(beam.thickness, 3) / 12;
    const double stiffness = 8 * ei / (mass * beam.length * beam.length);  // m/s²
    m_p_beam = &make<df::Beam>(df::Vector(0, 0), df::Vector(beam.length, 0), mass,
                               m_tick * m_tick * stiffness, true, beam.elements);
    constexpr double kFirstRoot = 1.8751040687119612;  // root of cos β cosh β = −1
    const double first = kFirstRoot * kFirstRoot * std::sqrt(ei / (mass * std::pow(beam.length, 3)));
    m_p_beam->setDrag(2 * beam.damping * first * m_tick);
    m_force = {0, -m_tick * m_tick * beam.tip_force};
  }

  void step(double tick, int substeps) override {
    m_p_beam->applyForce(freeEnd(), m_force);
    ProductWorld::step(tick, substeps);
  }
  BodyState body(int /*index*/) const override {
    return stateOf(m_p_beam->getNodePosition(freeEnd()), m_p_beam->getNodeVelocity(freeEnd()));
  }

 private:
  int freeEnd() const { return m_p_beam->getNodeCount() - 1; }

  df::Vector m_force;
  df::Beam* m_p_beam = nullptr;
};

}  // namespace

SimulationPtr clothByDefault(const Scene& scene) {
  return std::make_unique<DefaultCloth>(scene);
}

SimulationPtr beamByDefault(const Scene& scene) {
  if (scene.beams.size() != 1 || !scene.bodies.empty()) return nullptr;
  return std::make_unique<DefaultBeam>(scene);
}

}  // namespace lab
