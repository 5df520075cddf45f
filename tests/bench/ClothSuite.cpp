// The cost of a cloth with many nodes per tick, that is, per WM.update(), and the stretch of its threads.
#include <algorithm>
#include <cmath>

#include "ElapsedTime.h"
#include "ResultLine.h"
#include "Suite.h"
#include "engine/managers/WorldManager.h"
#include "engine/world/World.h"
#include "physics/body/PhysicsManager.h"
#include "physics/body/SoftObject.h"

namespace bench {
namespace {

/// Returns the largest stretch of a thread, relative to its rest length. `mesh` is in cells.
double stretchOf(const df::Cloth& cloth, df::Vector mesh) {
  double most = 0;
  const auto see = [&](int from, int to, double rest) {
    const df::Vector apart = cloth.getNodePosition(to) - cloth.getNodePosition(from);
    most = std::max(most, std::hypot(apart.x(), apart.y() * mesh.x() / mesh.y()) / rest - 1);
  };
  for (int i = 0; i + 1 < cloth.getColumns(); ++i) {
    for (int j = 0; j + 1 < cloth.getRows(); ++j) {
      see(cloth.getNode(i, j), cloth.getNode(i + 1, j), mesh.x());
      see(cloth.getNode(i, j), cloth.getNode(i, j + 1), mesh.x());
    }
  }
  return most;
}

void measure(int threads, int ticks) {
  progress("cloth: " + std::to_string(threads) + " threads each way");
  Line line("cloth");
  df::World world;
  const df::World::Scope scope(world);
  PM.setGravity(df::Vector(0, 0.02));
  const double width = threads - 1, height = width / PM.getAspect();  // square meshes
  auto* p_cloth = new df::Cloth(df::Vector(10, 5), width, height, 1, 5, threads, threads);
  p_cloth->pin(p_cloth->getNode(0, 0));
  p_cloth->pin(p_cloth->getNode(threads - 1, 0));
  double sum = 0, worst = 0, stretch = 0;
  for (int tick = 0; tick < ticks; ++tick) {
    const double begin = cpuNanoseconds();
    world.tick();
    const double ms = (cpuNanoseconds() - begin) / 1e6;
    sum += ms;
    worst = std::max(worst, ms);
    stretch = std::max(stretch, stretchOf(*p_cloth, {1, 1 / PM.getAspect()}));
  }
  world.shutDown();
  line.add("nodes", threads * threads).add("ticks", ticks);
  line.add("ms_per_tick", sum / ticks).add("worst_ms", worst).add("stretch", stretch);
  line.add("ok", worst <= 60 && stretch <= 0.05 ? 1 : 0);
}

const Suite s_suite("cloth", "cloths hung by two corners: time, and stretch of their threads",
                    [](const Options& options) {
                      for (const int threads : {25, 50, 100}) measure(threads, options.quick ? 30 : 300);
                    });

}  // namespace
}  // namespace bench
