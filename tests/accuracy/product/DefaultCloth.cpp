// A df::Cloth that hangs by its upper corners. A metre is a cell, a tick of the scene is a tick, mass is in
// kg; y points down here and up in the scene.
#include <memory>

#include "Default.h"
#include "engine/managers/WorldManager.h"
#include "engine/world/World.h"
#include "engine/world/WorldLog.h"
#include "physics/body/SoftObject.h"

namespace lab {

namespace {

class DefaultCloth : public Simulation {
 public:
  explicit DefaultCloth(const Scene& scene) : m_corner(scene.bodies.front().position), m_tick(scene.tick) {
    m_world.log().setSink([](const std::string&) {});
    const df::World::Scope scope(m_world);
    PM.setAspect(1);
    PM.setGravity({0, -m_tick * m_tick * scene.gravity.y});
    PM.setSleeping(scene.may_sleep);
    const Cloth& cloth = scene.cloths.front();
    m_p_cloth = std::make_unique<df::Cloth>(df::Vector(0, 0), cloth.mesh * (cloth.columns - 1),
                                            cloth.mesh * (cloth.rows - 1), cloth.mass,
                                            m_tick * m_tick * cloth.stiffness, cloth.columns, cloth.rows);
    m_p_cloth->pin(m_p_cloth->getNode(0, 0));
    m_p_cloth->pin(m_p_cloth->getNode(cloth.columns - 1, 0));
  }
  ~DefaultCloth() override {
    const df::World::Scope scope(m_world);
    m_p_cloth.reset();
  }
  DefaultCloth(const DefaultCloth&) = delete;
  DefaultCloth& operator=(const DefaultCloth&) = delete;

  void step(double /*tick*/, int /*substeps*/) override { m_world.update(); }

  BodyState body(int index) const override {
    const int columns = m_p_cloth->getColumns();
    const int node = m_p_cloth->getNode(index % columns, index / columns);
    const df::Vector position = m_p_cloth->getNodePosition(node);
    const df::Vector velocity = m_p_cloth->getNodeVelocity(node);
    BodyState state;
    state.position = {m_corner.x + position.x(), m_corner.y - position.y()};
    state.velocity = {velocity.x() / m_tick, -velocity.y() / m_tick};
    return state;
  }
  long frozen() const override { return m_p_cloth->isFrozen() ? 1 : 0; }
  std::optional<Work> work() const override { return Work{}; }

 private:
  df::World m_world;
  Vec m_corner;
  double m_tick;
  std::unique_ptr<df::Cloth> m_p_cloth;
};

}  // namespace

SimulationPtr clothByDefault(const Scene& scene) {
  return std::make_unique<DefaultCloth>(scene);
}

}  // namespace lab
