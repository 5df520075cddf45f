// Time per event including its handler: the time of a tick divided by its events, in a crowded world.
// Handlers only count, or also change velocities, or also delete and create Objects. (The time includes
// moving Objects and finding collisions.)
#include <memory>
#include <string>
#include <vector>

#include "Contest.h"
#include "ElapsedTime.h"
#include "NaiadEngine.h"
#include "ResultLine.h"
#include "Scene.h"
#include "Suite.h"
#include "engine/events/EventOut.h"
#include "engine/managers/WorldManager.h"
#include "engine/world/EventCollision.h"
#include "engine/world/Object.h"
#include "engine/world/World.h"
#include "shared/values/SplitMix64.h"

namespace bench {
namespace {

constexpr int kObjects = 10'000;
constexpr double kDensity = 0.5;
constexpr std::uint64_t kSpawnEvery = 100;  // collision events from one deletion to the next

enum class Kind {
  COUNT,     ///< handlers only count events
  VELOCITY,  ///< handlers also reverse their Object, whether it moved or not
  SPAWN,     ///< every 100th event also makes its handler delete the Object and create another one elsewhere
};

struct Crowd {
  Kind kind;
  double side;
  std::uint64_t events = 0;
  std::uint64_t until_spawn = kSpawnEvery;
  naiad::SplitMix64 random{7};
};

class Citizen : public df::Object {
 public:
  Citizen(const Body& body, Crowd& crowd) : m_crowd(crowd) {
    setType("Citizen");
    setSolidness(body.solidness);
    setPosition(df::Vector(body.x, body.y));
    setVelocity(df::Vector(body.vx, body.vy));
  }

  int eventHandler(const df::Event* p_e) override {
    if (p_e->getType() == df::COLLISION_EVENT) return hit();
    if (p_e->getType() != df::OUT_EVENT) return 0;
    turnBack(*this, m_crowd.side);
    return 1;
  }

 private:
  int hit() {
    ++m_crowd.events;
    if (m_crowd.kind == Kind::VELOCITY) {
      const df::Vector v = getVelocity();
      setVelocity(df::Vector(-v.x(), -v.y()));
    }
    if (m_crowd.kind == Kind::SPAWN && --m_crowd.until_spawn == 0) {
      m_crowd.until_spawn = kSpawnEvery;
      replace();
    }
    return 1;
  }

  void replace() {
    if (m_leaving) return;
    m_leaving = true;
    const auto side = static_cast<std::uint64_t>(m_crowd.side);
    const df::Vector v = getVelocity();
    Body next;
    next.x = static_cast<double>(m_crowd.random.below(side));
    next.y = static_cast<double>(m_crowd.random.below(side));
    next.vx = v.x();
    next.vy = v.y();
    next.solidness = getSolidness();
    new Citizen(next, m_crowd);
    WM.markForDelete(this);
  }

  Crowd& m_crowd;
  bool m_leaving = false;
};

std::string nameOf(Kind kind) {
  constexpr const char* kNames[] = {"count", "velocity", "spawn"};  // in the enum's order
  return kNames[static_cast<int>(kind)];
}

void measure(Kind kind, const Options& options) {
  progress("handlers: " + nameOf(kind));
  const Scene scene(Mix::MIXED, kObjects, kDensity);
  Crowd crowd{kind, scene.side};
  df::World world;
  const df::World::Scope scope(world);
  WM.setBoundary(df::Box(df::Vector(), scene.side, scene.side));
  for (const Body& body : scene.bodies) new Citizen(body, crowd);

  const int ticks = options.quick ? 3 : 10;
  for (int i = 0; i < ticks; ++i) WM.update();
  std::vector<double> per_event;
  std::vector<double> per_object;
  std::vector<double> events;
  for (int repetition = 0; repetition < (options.quick ? 3 : 9); ++repetition) {
    const std::uint64_t before = crowd.events;
    const double begin = cpuNanoseconds();
    for (int i = 0; i < ticks; ++i) WM.update();
    const double time = cpuNanoseconds() - begin;
    events.push_back(static_cast<double>(crowd.events - before) / ticks);
    per_event.push_back(time / ticks / events.back());
    per_object.push_back(time / ticks / kObjects);
  }
  Line("handlers")
      .add("n", kObjects)
      .add("kind", nameOf(kind))
      .add("ns_per_event", median(per_event))
      .add("ns_per_object", median(per_object))
      .add("events_per_object", median(events) / kObjects);
  world.shutDown();
}

const Suite s_suite("handlers",
                    "cost per collision event, with handlers that count, steer, or delete and create",
                    [](const Options& options) {
                      for (const Kind kind : {Kind::COUNT, Kind::VELOCITY, Kind::SPAWN})
                        measure(kind, options);
                    });

}  // namespace
}  // namespace bench
