// The product's two levels, each with equal settings in every problem.
#include "Default.h"

#include "Method.h"
#include "ProductWorld.h"

namespace lab {
namespace {

/// Plain Objects, which move by their velocities, for scenes without physics.
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

SimulationPtr build(const Scene& scene) {
  if (!scene.cloths.empty()) return clothByDefault(scene);
  if (scene.massless) return std::make_unique<DefaultObjects>(scene);
  if (scene.abstract()) return equationsByDefault(scene);
  return scene.beams.empty() ? bodiesAt(df::ACCURACY_DEFAULT, scene) : beamByDefault(scene);
}

// Returns null for all scenes but those of bodies, because other scenes do not depend on the level.
SimulationPtr buildFast(const Scene& scene) {
  return scene.rigid() && scene.cloths.empty() ? bodiesAt(df::ACCURACY_FAST, scene) : nullptr;
}

constexpr int kFastSubsteps = 4;  // sub-steps of the fast level per tick (docs/physics/substep.md)

const RegisteredMethod method({"default", "Naiad", "0.1.0", Method::Kind::PRODUCT, build, 1});
const RegisteredMethod fast({"fast", "Naiad, fast level", "0.1.0", Method::Kind::FAST, buildFast,
                             kFastSubsteps});

}  // namespace
}  // namespace lab
