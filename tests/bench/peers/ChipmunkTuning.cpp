// Finds the best cell and table sizes for each kind of scene by trial.
#include <algorithm>
#include <limits>
#include <map>
#include <tuple>
#include <vector>

#include "ElapsedTime.h"
#include "Peers.h"

namespace bench {
namespace {

constexpr int kMaxObjects = 100'000;
constexpr int kObjectTurns = 200'000;  // turns of objects in a trial

int ticksFor(const Scene& scene) {
  return std::max(2, kObjectTurns / std::max(1, scene.countMoving()));
}

double timeOf(const Scene& scene, double cell, int table_per_object) {
  const EnginePtr engine = makeChipmunkHash(scene, cell, table_per_object * scene.count());
  const int ticks = ticksFor(scene);
  for (int i = 0; i < ticks / 2; ++i) engine->tick();
  const double begin = cpuNanoseconds();
  for (int i = 0; i < ticks; ++i) engine->tick();
  return cpuNanoseconds() - begin;
}

// Tries cell sizes with the table length that the manual recommends, then table lengths with the best cell
// size.
ChipmunkTuning tryAll(const Scene& scene) {
  std::vector<double> cells = {1, 1.5, 2, 3, 4, 6};
  if (scene.mix == Mix::SPRITES) cells = {2, 3, 4, 6, 8, 12, 16};
  ChipmunkTuning best;
  best.table_per_object = 10;
  double least = std::numeric_limits<double>::max();
  for (const double cell : cells) {
    const double time = timeOf(scene, cell, best.table_per_object);
    if (time >= least) continue;
    least = time;
    best.cell = cell;
  }
  for (const int table : {1, 2, 4, 20, 40}) {
    const double time = timeOf(scene, best.cell, table);
    if (time >= least) continue;
    least = time;
    best.table_per_object = table;
  }
  return best;
}

}  // namespace

ChipmunkTuning tuneChipmunk(const Scene& scene) {
  static std::map<std::tuple<Mix, double, int>, ChipmunkTuning> s_known;
  const int n = std::min(scene.count(), kMaxObjects);
  const auto [known, is_new] = s_known.try_emplace({scene.mix, scene.density, n});
  if (is_new) {
    known->second = tryAll(n == scene.count() ? scene : Scene(scene.mix, n, scene.density));
  }
  ChipmunkTuning best = known->second;
  best.table = best.table_per_object * scene.count();
  return best;
}

}  // namespace bench
