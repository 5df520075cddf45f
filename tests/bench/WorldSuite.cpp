// The cost of an object per tick in the everyday workload (Scene.h), compared with Chipmunk, Box2D and the
// loop of the Dragonfly book. The suite `growth` measures how it grows with the number of objects;
// tests/bench/plot draws the result.
#include <algorithm>
#include <string>
#include <vector>

#include "Contest.h"
#include "NaiadEngine.h"
#include "ResultLine.h"
#include "Scene.h"
#include "Suite.h"
#include "peers/Peers.h"
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

}  // namespace
}  // namespace bench
