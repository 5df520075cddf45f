// The product's two levels, each with equal settings in every problem.
#include "Default.h"

#include "Method.h"

namespace lab {
namespace {

SimulationPtr build(const Scene& scene) {
  if (!scene.cloths.empty()) return clothByDefault(scene);
  if (scene.massless) return objectsByDefault(scene);
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
