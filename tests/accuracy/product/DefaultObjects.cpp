// The book's Objects, which move by their velocity: what a scene without physics consists of. A metre is a
// cell.
#include <memory>
#include <vector>

#include "Default.h"
#include "engine/world/Object.h"
#include "engine/world/World.h"
#include "engine/world/WorldLog.h"

namespace lab {

namespace {

class DefaultObjects : public Simulation {
 public:
  explicit DefaultObjects(const Scene& scene) : m_tick(scene.tick) {
    m_world.log().setSink([](const std::string&) {});
    const df::World::Scope scope(m_world);
    for (const Body& body : scene.bodies) {
      m_objects.push_back(std::make_unique<df::Object>());
      df::Object& made = *m_objects.back();
      made.setSolidness(scene.blocks ? df::HARD : scene.hearing ? df::SOFT : df::SPECTRAL);
      made.setPosition({body.position.x, body.position.y});
      made.setVelocity({m_tick * body.velocity.x, m_tick * body.velocity.y});
    }
  }
  ~DefaultObjects() override {
    const df::World::Scope scope(m_world);
    m_objects.clear();
  }
  DefaultObjects(const DefaultObjects&) = delete;
  DefaultObjects& operator=(const DefaultObjects&) = delete;

  void step(double /*tick*/, int /*substeps*/) override { m_world.update(); }
  std::optional<Work> work() const override { return Work{}; }

  BodyState body(int index) const override {
    const df::Object& object = *m_objects[static_cast<std::size_t>(index)];
    const df::Vector position = object.getPosition(), velocity = object.getVelocity();
    BodyState state;
    state.position = {position.x(), position.y()};
    state.velocity = {velocity.x() / m_tick, velocity.y() / m_tick};
    return state;
  }

 private:
  df::World m_world;
  double m_tick;
  std::vector<std::unique_ptr<df::Object>> m_objects;
};

}  // namespace

SimulationPtr objectsByDefault(const Scene& scene) {
  return std::make_unique<DefaultObjects>(scene);
}

}  // namespace lab
