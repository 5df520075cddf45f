// The cost of an object per tick in the everyday workload (Scene.h), compared with Chipmunk, Box2D and the
// loop of the Dragonfly book. The suite `growth` measures how it grows with the number of objects;
// tests/bench/plot draws the result.
#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "Contest.h"
#include "ElapsedTime.h"
#include "NaiadEngine.h"
#include "ResultLine.h"
#include "Scene.h"
#include "Suite.h"
#include "engine/managers/WorldManager.h"
#include "engine/world/EventCollision.h"
#include "engine/world/Object.h"
#include "engine/world/World.h"
#include "peers/Peers.h"
#include "shared/values/SplitMix64.h"
#include "textbook/Textbook.h"

namespace bench {
namespace {

constexpr int kLarge = 1'000'000;  // with this number of objects, only one engine of each library runs
// If a peer's whole tick would take long, it moves only some of its objects.
constexpr int kWholeTextbook = 10'000;
constexpr int kLargestTextbook = 100'000;
constexpr int kTextbookTurns = 200;
constexpr int kWholeBox2d = 100'000;
constexpr int kBox2dTurns = 10'000;

struct Case {
  Mix mix;
  int n;
  double density;

  bool isMotionOnly() const { return mix == Mix::MOVING || mix == Mix::MOVING_HARD; }
};

void addTextbook(Contest& contest, const Scene& scene) {
  const int n = scene.count();
  const bool loops = scene.mix != Mix::MOVING;  // without solid objects, moves have no loop over all
  if (scene.mix == Mix::SPRITES || scene.mix == Mix::MOVING_HARD || scene.mix == Mix::REST) return;
  if (loops && n > kLargestTextbook) return;
  const int turns = loops && n > kWholeTextbook ? kTextbookTurns : n;
  contest.add("textbook", textbook::makeEngine(scene, turns));
  contest.add("textbook_inlined", textbook_inlined::makeEngine(scene, turns));
}

void addBox2d(Contest& contest, const Scene& scene) {
  contest.add("box2d", makeBox2dWorld(scene, scene.count() > kWholeBox2d ? kBox2dTurns : scene.count()));
}

void addIndices(Contest& contest, const Scene& scene, const ChipmunkTuning& tuning) {
  contest.add("chipmunk_hash", makeChipmunkHash(scene, tuning.cell, tuning.table));
  if (scene.count() < kLarge) {
    contest.add("chipmunk_space", makeChipmunkSpace(scene, tuning.cell, tuning.table));
    contest.add("chipmunk_tree", makeChipmunkTree(scene));
    contest.add("box2d_tree", makeBox2dTree(scene));
  }
  addBox2d(contest, scene);
}

void addRatio(Line& line, const Contest& contest, const std::string& key, const std::string& name) {
  if (contest.has(name)) line.add(key, contest.ratio(name));
}

void addChipmunk(Line& line, const Contest& contest, const ChipmunkTuning& tuning, int n) {
  if (!contest.has("chipmunk_hash")) return;
  double fastest = contest.nanosecondsPerTick("chipmunk_hash");
  for (const char* name : {"chipmunk_space", "chipmunk_tree"}) {
    if (contest.has(name)) fastest = std::min(fastest, contest.nanosecondsPerTick(name));
  }
  line.add("chipmunk_ns", fastest / n);
  for (const char* name : {"chipmunk_hash", "chipmunk_space", "chipmunk_tree"}) {
    addRatio(line, contest, std::string(name) + "_ratio", name);
  }
  line.add("chipmunk_cell", tuning.cell).add("chipmunk_table_per_object", tuning.table_per_object);
}

// Adds the share of turns that took each of the engine's paths. (The broad phase has fewer searches than
// turns, because flights need none.)
void addPaths(Line& line, const df::MoverStats& paths) {
  const auto turns = static_cast<double>(paths.flown + paths.walked + paths.met + paths.unheard +
                                         paths.deferred + paths.special);
  for (const df::NamedPath& path : df::kMoverStats) {
    line.add("path_" + std::string(path.name) + "_percent",
             100 * static_cast<double>(paths.*path.count) / turns);
  }
}

void report(const Case& c, const Scene& scene, const Contest& contest, const ChipmunkTuning& tuning,
            const df::MoverStats& paths) {
  const double ours = contest.nanosecondsPerTick("naiad");
  Line line("world");
  line.add("n", c.n).add("density", c.density).add("mix", nameOf(c.mix)).add("ns_per_object", ours / c.n);
  addRatio(line, contest, "chipmunk_ratio", "chipmunk_hash");
  addRatio(line, contest, "box2d_ratio", "box2d");
  addRatio(line, contest, "textbook_ratio", "textbook");
  line.add("blocked_percent", 100 * contest.blockedPerTick() / scene.countMoving());
  line.add("events_per_object", contest.eventsPerTick() / c.n);
  addRatio(line, contest, "all_moving_ratio", "all_moving");
  addChipmunk(line, contest, tuning, c.n);
  if (contest.has("box2d")) line.add("box2d_ns", contest.nanosecondsPerTick("box2d") / c.n);
  addRatio(line, contest, "box2d_tree_ratio", "box2d_tree");
  if (contest.has("textbook")) line.add("textbook_ns", contest.nanosecondsPerTick("textbook") / c.n);
  addRatio(line, contest, "textbook_inlined_ratio", "textbook_inlined");
  addPaths(line, paths);
  line.addEqual(contest.equal());
}

void measure(const Case& c, const Options& options) {
  progress("world: " + nameOf(c.mix) + ", " + std::to_string(c.n) + " at density " +
           std::to_string(c.density));
  const Scene scene(c.mix, c.n, c.density);
  Contest::Rules rules = Contest::rulesFor(c.n, options);
  if (c.mix == Mix::MOVING_HARD) {
    rules.compared_ticks = kLonelyTicks;
    rules.warm_up_ticks = std::min(rules.warm_up_ticks, kLonelyTicks);
  }
  Contest contest(rules);
  auto p_ours = std::make_unique<NaiadEngine>(scene);
  const df::MoverStats& paths = p_ours->moverStats();  // remains valid because the contest keeps the engine
  contest.add("naiad", std::move(p_ours));
  ChipmunkTuning tuning;
  if (c.isMotionOnly()) {
    contest.add("box2d", makeBox2dMotion(scene));
  } else {
    tuning = tuneChipmunk(scene);
    addIndices(contest, scene, tuning);
  }
  if (c.mix == Mix::REST) {
    const Scene moving(Mix::HARD_ONLY, c.n, c.density);
    contest.add("all_moving", std::make_unique<NaiadEngine>(moving), false);
  }
  addTextbook(contest, scene);
  contest.run();
  report(c, scene, contest, tuning, paths);
}

std::vector<Case> cases(const Options& options) {
  const std::vector<int> sizes =
      options.quick ? std::vector<int>{1000} : std::vector<int>{1000, 10'000, 100'000, kLarge};
  std::vector<Case> all;
  for (const Mix mix : {Mix::HARD_ONLY, Mix::MIXED, Mix::SPRITES}) {
    for (const double density : {0.1, 0.5}) {
      for (const int n : sizes) {
        if (n < kLarge || mix != Mix::SPRITES) all.push_back({mix, n, density});
      }
    }
  }
  for (const int n : sizes) all.push_back({Mix::MOVING, n, 0.1});
  for (const int n : sizes) all.push_back({Mix::MOVING_HARD, n, 0.0001});
  all.push_back({Mix::REST, options.quick ? 10'000 : 100'000, 0.1});
  return all;
}

const Suite s_suite("world", "cost per object and tick, against Chipmunk, Box2D and the book's loop",
                    [](const Options& options) {
                      for (const Case& c : cases(options)) measure(c, options);
                    });

// Returns our engine's cost per object, in ns. `least` is the cost in the smallest world, or 0 if this is the
// smallest.
double measureGrowth(int n, double least, const Options& options) {
  progress("growth: " + std::to_string(n));
  const Scene scene(Mix::MIXED, n, 0.1);
  const ChipmunkTuning tuning = tuneChipmunk(scene);
  Contest contest(Contest::rulesFor(n, options));
  contest.add("naiad", std::make_unique<NaiadEngine>(scene));
  contest.add("chipmunk", makeChipmunkHash(scene, tuning.cell, tuning.table));
  addBox2d(contest, scene);
  if (n <= kWholeTextbook) contest.add("textbook", textbook::makeEngine(scene, n));
  contest.run();

  const double ours = contest.nanosecondsPerTick("naiad") / n;
  Line line("growth");
  line.add("n", n).add("ns_per_object", ours).add("relative_to_1k", least > 0 ? ours / least : 1.0);
  for (const char* name : {"chipmunk", "box2d", "textbook"}) {
    if (contest.has(name)) line.add(std::string(name) + "_ns", contest.nanosecondsPerTick(name) / n);
  }
  line.addEqual(contest.equal());
  return ours;
}

const Suite s_growth("growth", "cost per object and tick from a thousand objects to a million",
                     [](const Options& options) {
                       double least = 0;
                       for (const int n : {1000, 3000, 10'000, 30'000, 100'000, 300'000, 1'000'000}) {
                         if (options.quick && n > 10'000) break;
                         const double ours = measureGrowth(n, least, options);
                         if (least == 0) least = ours;
                       }
                     });

// Time per event including its handler: the time of a tick divided by its events, in a crowded world.
// Handlers only count, or also change velocities, or also delete and create Objects. (The time includes
// moving Objects and finding collisions.)

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
  Tally tally{};
  std::uint64_t until_spawn = kSpawnEvery;
  naiad::SplitMix64 random{7};
};

class Citizen : public Ball {
 public:
  Citizen(const Body& body, Crowd& crowd) : Ball(body, 0, crowd.side, crowd.tally), m_crowd(crowd) {}

  int eventHandler(const df::Event* p_e) override {
    return p_e->getType() == df::COLLISION_EVENT ? hit() : Ball::eventHandler(p_e);
  }

 private:
  int hit() {
    ++m_crowd.tally.events;
    if (m_crowd.kind == Kind::VELOCITY) reverse(*this);
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
    const std::uint64_t before = crowd.tally.events;
    const double begin = cpuNanoseconds();
    for (int i = 0; i < ticks; ++i) WM.update();
    const double time = cpuNanoseconds() - begin;
    events.push_back(static_cast<double>(crowd.tally.events - before) / ticks);
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

const Suite s_handlers("handlers",
                       "cost per collision event, with handlers that count, steer, or delete and create",
                       [](const Options& options) {
                         for (const Kind kind : {Kind::COUNT, Kind::VELOCITY, Kind::SPAWN})
                           measure(kind, options);
                       });

}  // namespace
}  // namespace bench
