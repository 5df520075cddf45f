// Plain Objects, which move by their velocities, for scenes without physics.
#include "Default.h"
#include "ProductWorld.h"

namespace lab {
namespace {

class DefaultObjects : public ProductWorld {
 public:
  explicit DefaultObjects(const Scene& scene) : ProductWorld(scene) {
    const df::World::Scope scope(m_world);
    for (const Body& body : scene.bodies) {
      auto& made = make<df::Object>();
      made.setSolidness(scene.blocks ? df::HARD : scene.hearing ? df::SOFT : df::SPECTRAL);
      made.setPosition({body.position.x, body.position.y});
      made.setVelocity({m_tick * body.velocity.x, m_tick * body.velocity.y});
      m_made.push_back(&made);
    }
  }

  BodyState body(int index) const override {
    const df::Object& object = *m_made[static_cast<std::size_t>(index)];
    return stateOf(object.getPosition(), object.getVelocity());
  }

 private:
  std::vector<const df::Object*> m_made;  // indexed by scene body
};

}  // namespace

SimulationPtr objectsByDefault(const Scene& scene) {
  return std::make_unique<DefaultObjects>(scene);
}

}  // namespace lab
