// The product's own automatic choice, with the same settings in every problem.
#include "Default.h"

#include "Method.h"

namespace lab {

namespace {

SimulationPtr build(const Scene& scene) {
  if (scene.massless) return objectsByDefault(scene);
  if (scene.abstract()) return equationsByDefault(scene);
  return scene.beams.empty() ? bodiesByDefault(scene) : beamByDefault(scene);
}

const RegisteredMethod method({"default", "Naiad", "0.1.0", Method::Kind::PRODUCT, build, 1});

}  // namespace

}  // namespace lab
