// Measures how the cost of an object grows with the number of objects. tests/bench/plot draws the result.
#include <memory>
#include <string>

#include "Contest.h"
#include "NaiadEngine.h"
#include "ResultLine.h"
#include "Scene.h"
#include "Suite.h"
#include "peers/Peers.h"
#include "textbook/Textbook.h"

namespace bench {
namespace {

constexpr double kDensity = 0.1;
constexpr int kLargestTextbook = 10'000;
// With more objects than this, Box2D moves only kBox2dTurns of them, because a whole tick would take seconds.
constexpr int kWholeBox2d = 100'000;
constexpr int kBox2dTurns = 10'000;

// Returns our engine's cost per object, in ns. `least` is the cost in the smallest world, or 0 if this is the
// smallest.
double measure(int n, double least, const Options& options) {
  progress("growth: " + std::to_string(n));
  const Scene scene(Mix::MIXED, n, kDensity);
  const ChipmunkTuning tuning = tuneChipmunk(scene);
  Contest contest(Contest::rulesFor(n, options));
  contest.add("naiad", std::make_unique<NaiadEngine>(scene));
  contest.add("chipmunk", makeChipmunkHash(scene, tuning.cell, tuning.table));
  contest.add("box2d", makeBox2dWorld(scene, n > kWholeBox2d ? kBox2dTurns : n));
  if (n <= kLargestTextbook) contest.add("textbook", textbook::makeEngine(scene, n));
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

const Suite s_suite("growth", "cost per object and tick from a thousand objects to a million",
                    [](const Options& options) {
                      double least = 0;
                      for (const int n : {1000, 3000, 10'000, 30'000, 100'000, 300'000, 1'000'000}) {
                        if (options.quick && n > 10'000) break;
                        const double ours = measure(n, least, options);
                        if (least == 0) least = ours;
                      }
                    });

}  // namespace
}  // namespace bench
