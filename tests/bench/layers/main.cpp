// naiad_layers: runs a scene whose Objects use a layer of the engine, or not. The suite `layers` runs it
// alone and in valgrind, and counts.
//
//     naiad_layers SCENE LAYER one|sixteen|all TICKS
//
// The scene has an additional moving Object far from all others, or sixteen that stand scattered among them.
// Only the additional Objects use the layer ("one", "sixteen"), or all do ("all"). No Object reaches a
// border. Prints `allocations_per_tick=… bytes_per_object=…`.
#include <malloc.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>

#include "engine/managers/WorldManager.h"
#include "engine/world/EventCollision.h"
#include "engine/world/Object.h"
#include "engine/world/World.h"
#include "tests/bench/Scene.h"
#include "tests/support/AllocationCount.h"

namespace bench {
namespace {

/// Returns the bytes that this process has allocated, including the engine's library.
long allocatedBytes() {
  const auto info = mallinfo2();
  return static_cast<long>(info.uordblks + info.hblkhd);
}

constexpr int kScattered = 16;
constexpr int kWarmUpTicks = 8;

using Use = void (*)(df::Object&);

// A body that turns around when it is blocked.
class Walker : public df::Object {
 public:
  explicit Walker(const Body& body) {
    setSolidness(body.solidness);
    setPosition(df::Vector(body.x, body.y));
    setVelocity(df::Vector(body.vx, body.vy));
  }

  int eventHandler(const df::Event* p_e) override {
    if (p_e->getType() != df::COLLISION_EVENT) return 0;
    if (static_cast<const df::EventCollision*>(p_e)->getObject1() != this) return 1;
    reverse(*this);
    return 1;
  }
};

const std::map<std::string, Use> kLayers = {
    {"none", [](df::Object&) {}},
    {"swept", [](df::Object& o) { o.setSwept(); }},
    {"precise", [](df::Object& o) { o.setPrecise(); }},
    {"masks",
     [](df::Object& o) {
       o.setMask({"  ########  ", " ##  ##  ## ", "############", "##   ##   ##"});
       o.setPrecise();
     }},
    {"sprite", [](df::Object& o) { o.setBox(df::Box(df::Vector(-2.5, -1.5), 5, 3)); }},
    {"wall", [](df::Object& o) { o.setBox(df::Box(df::Vector(-250, -0.5), 500, 1)); }},
    {"rest_contacts", [](df::Object& o) { o.setRestContacts(); }},
    {"may_move_out", [](df::Object& o) { o.setMayMoveOut(); }},
};

const std::map<std::string, Scene (*)()> kScenes = {
    {"moving", [] { return Scene(Mix::MOVING, 10'000, 0.1); }},
    {"moving_hard", [] { return Scene(Mix::MOVING_HARD, 10'000, 0.0001); }},
    {"hard", [] { return Scene(Mix::HARD_ONLY, 10'000, 0.1); }},
    {"hard_1000", [] { return Scene(Mix::HARD_ONLY, 1'000, 0.1); }},
    {"hard_4000", [] { return Scene(Mix::HARD_ONLY, 4'000, 0.1); }},
};

// Adds sixteen standing bodies, one in the middle of each sixteenth of the scene.
void scatter(const Scene& scene, Use use) {
  Body body = scene.bodies.front();
  body.vx = body.vy = 0;
  for (int i = 0; i < kScattered; ++i) {
    body.x = scene.side * (i % 4 + 0.5) / 4;
    body.y = scene.side * (i / 4 + 0.5) / 4;
    use(*new Walker(body));
  }
}

void run(const Scene& scene, Use use, const std::string& who, int ticks) {
  const int objects = scene.count();
  const long bytes = allocatedBytes();
  df::World world;
  const df::World::Scope scope(world);
  WM.setBoundary(df::Box(df::Vector(-1e5, -1e5), 5e5, 5e5));
  for (const Body& body : scene.bodies) {
    auto* p_walker = new Walker(body);
    if (who == "all") use(*p_walker);
  }
  if (who == "sixteen") {
    scatter(scene, use);
  } else {
    Body far = scene.bodies.front();
    far.x = far.y = -1000;
    far.vx = far.vy = -0.25;
    use(*new Walker(far));
  }

  for (int i = 0; i < kWarmUpTicks; ++i) WM.update();
  const long bytes_per_object = (allocatedBytes() - bytes) / objects;
  const std::uint64_t allocations = naiad::test::allocationsSoFar();
  for (int i = 0; i < ticks; ++i) WM.update();
  const double per_tick = static_cast<double>(naiad::test::allocationsSoFar() - allocations) / ticks;
  std::printf("allocations_per_tick=%g bytes_per_object=%ld\n", per_tick, bytes_per_object);
  world.shutDown();
}

}  // namespace

}  // namespace bench

int main(int argc, char** argv) {
  const int ticks = argc == 5 ? std::atoi(argv[4]) : 0;
  if (ticks < 1 || !bench::kScenes.contains(argv[1]) || !bench::kLayers.contains(argv[2])) {
    std::fputs("usage: naiad_layers SCENE LAYER one|sixteen|all TICKS\n", stderr);
    return 2;
  }
  const bench::Scene scene = bench::kScenes.at(argv[1])();
  bench::run(scene, bench::kLayers.at(argv[2]), argv[3], ticks);
  return 0;
}
