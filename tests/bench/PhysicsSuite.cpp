// Cost per tick of scenes of rigid bodies, compared with Box2D, and how deep bodies overlap during them.
//
// Both engines start from equal positions and run one after the other. Every tick counts, including the
// first.
#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <limits>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "Contest.h"
#include "ElapsedTime.h"
#include "ResultLine.h"
#include "Suite.h"
#include "physics/Run.h"
#include "physics/Scenes.h"
#include "tests/accuracy/frame/Method.h"
#include "tests/accuracy/product/Default.h"

namespace bench {
namespace {

using physics::Run;

constexpr int kRounds = 3;
constexpr double kMostSeconds = 20;  // CPU time limit of a run
constexpr double kAny = std::numeric_limits<double>::infinity();

/// Requirements for printing `ok=1`.
struct Target {
  double least_ratio = 1;
  double most_overlap = kAny;
  double most_joint_error = kAny;
};

struct Level {
  df::Accuracy accuracy;
  Target target;
  bool quick = true;  ///< also runs with --quick

  const char* name() const { return accuracy == df::ACCURACY_FAST ? "fast" : "default"; }
};

struct Case {
  const char* name;
  lab::Scene (*make)();
  std::vector<Level> levels;
};

constexpr df::Accuracy kFast = df::ACCURACY_FAST;
constexpr df::Accuracy kDefault = df::ACCURACY_DEFAULT;

const std::vector<Case> kCases = {
    {"pyramid60", lab::makePyramid60, {{kFast, {7.5, .036}}, {kDefault, {}}}},
    {"pyramids100", lab::makePyramids100, {{kFast, {10, .005}}, {kDefault, {}}}},
    {"tumbler500", lab::makeTumbler500, {{kFast, {3, .063}}, {kDefault, {1, .016}}}},
    {"heap2000", lab::makeHeap2000, {{kFast, {2.5, .125}}, {kDefault, {}}}},
    {"heap20000", lab::makeHeap20000, {{kFast, {2.5, .1}}, {kDefault, {}, false}}},
    {"smash", lab::makeSmash, {{kFast, {10, .14}}, {kDefault, {}}}},
    {"chain100", lab::makeChain100, {{kFast, {}}, {kDefault, {.5, kAny, 1e-9}}}},
    {"grid100", lab::makeGrid100, {{kFast, {2, kAny, .4}}, {kDefault, {}}}},
};

struct Round {
  Run ours;
  Run box2d;

  /// Number of ticks that both runs have, because a run may have been stopped at its time limit. Only these
  /// are compared.
  std::size_t ticks() const { return std::min(ours.tick_ms.size(), box2d.tick_ms.size()); }
  double ratio() const { return box2d.meanMs(ticks()) / ours.meanMs(ticks()); }
};

Run checkedRun(const lab::Scene& scene, const lab::SimulationPtr& simulation, int substeps) {
  physics::demandStart(scene, *simulation);
  return physics::run(scene, *simulation, substeps, kMostSeconds);
}

Round runRound(const lab::Scene& scene, df::Accuracy accuracy) {
  const lab::Method& box2d = *lab::Method::all().front();  // the only one in this program
  return {checkedRun(scene, lab::bodiesAt(accuracy, scene), 1),
          checkedRun(scene, box2d.build(scene), lab::kBox2dSteps)};
}

template <class Value>
double medianOf(const std::vector<Round>& rounds, Value value) {
  std::vector<double> values;
  for (const Round& round : rounds) values.push_back(value(round));
  return median(values);
}

// Reports the errors of the first round, because in each round the engines get equal results.
void addErrors(Line& line, const std::string& prefix, const lab::Scene& scene, const Run& run) {
  if (run.looks == 0) return;
  if (scene.collides) line.add(prefix + "overlap_m", run.meanOverlap());
  if (!scene.joints.empty()) line.add(prefix + "joint_error_m", run.joint_error);
}

bool meets(const Target& target, double ratio, const Run& run) {
  const double overlap = run.overlaps.empty() ? 0 : run.meanOverlap();
  return !run.cut && run.failed == 0 && ratio >= target.least_ratio && overlap <= target.most_overlap &&
         run.joint_error <= target.most_joint_error;
}

void report(Line& line, const Level& level, const lab::Scene& scene, const std::vector<Round>& rounds) {
  const Run& ours = rounds.front().ours;
  const double ratio = medianOf(rounds, [](const Round& r) { return r.ratio(); });
  line.add("ms_per_tick", medianOf(rounds, [](const Round& r) { return r.ours.meanMs(r.ticks()); }));
  line.add("worst_ms", medianOf(rounds, [](const Round& r) { return r.ours.worstMs(); }));
  addErrors(line, "", scene, ours);
  line.add("box2d_ms", medianOf(rounds, [](const Round& r) { return r.box2d.meanMs(r.ticks()); }));
  addErrors(line, "box2d_", scene, rounds.front().box2d);
  line.add("box2d_ratio", ratio);
  if (ours.cut) line.add("cut", 1).add("ticks", static_cast<int>(ours.tick_ms.size()));
  line.addZero("failed", ours.failed);
  line.add("ok", meets(level.target, ratio, ours) ? 1 : 0);
}

void measure(const Case& c, const Level& level, const Options& options) {
  if (options.quick && !level.quick) return;
  progress(std::string("physics: ") + c.name + ", " + level.name());
  const lab::Scene scene = c.make();
  Line line("physics");
  line.add("scene", c.name).add("level", level.name()).add("sleep", scene.may_sleep ? "on" : "off");
  line.add("bodies", scene.countDynamic());
  std::vector<Round> rounds;
  const std::size_t wanted = options.quick ? 1 : kRounds;
  while (rounds.size() < wanted && (rounds.empty() || !rounds.back().ours.cut)) {
    rounds.push_back(runRound(scene, level.accuracy));
  }
  report(line, level, scene, rounds);
}

/// Returns the cases named in NAIAD_PHYSICS_SCENES, or all.
std::vector<Case> wantedCases() {
  std::vector<std::string> all;
  for (const Case& c : kCases) all.emplace_back(c.name);
  std::vector<Case> wanted;
  for (const std::string& name : namesFrom("NAIAD_PHYSICS_SCENES", all)) {
    const auto found = std::ranges::find(kCases, name, &Case::name);
    if (found == kCases.end()) throw std::runtime_error("there is no scene '" + name + "'");
    wanted.push_back(*found);
  }
  return wanted;
}

const Suite s_suite("physics", "scenes of rigid bodies, against Box2D: time and overlap",
                    [](const Options& options) {
                      const char* only = std::getenv("NAIAD_PHYSICS_LEVEL");
                      for (const Case& c : wantedCases()) {
                        for (const Level& level : c.levels) {
                          if (only == nullptr || std::string_view(level.name()) == only)
                            measure(c, level, options);
                        }
                      }
                    });

// The cost of a cloth with many nodes per tick, that is, per WM.update(), and the stretch of its threads.
void measure(int threads, int ticks) {
  constexpr double kGravity = 36;  // m/s²: 0.02 cells per tick² if a cell is twice as high as wide
  progress("cloth: " + std::to_string(threads) + " threads each way");
  Line line("cloth");
  const lab::Scene scene = lab::makeCloth(threads, kGravity);
  const lab::SimulationPtr cloth = lab::clothByDefault(scene);
  double sum = 0, worst = 0, stretch = 0;
  for (int tick = 0; tick < ticks; ++tick) {
    const double begin = cpuNanoseconds();
    cloth->step(scene.tick, 1);
    const double ms = (cpuNanoseconds() - begin) / 1e6;
    sum += ms;
    worst = std::max(worst, ms);
    stretch = std::max(stretch, lab::widestStretch(scene, lab::statesOf(scene, *cloth)));
  }
  line.add("nodes", threads * threads).add("ticks", ticks);
  line.add("ms_per_tick", sum / ticks).add("worst_ms", worst).add("stretch", stretch);
  line.add("ok", worst <= 60 && stretch <= 0.05 ? 1 : 0);
}

const Suite s_cloth("cloth", "cloths hung by two corners: time, and stretch of their threads",
                    [](const Options& options) {
                      for (const int threads : {25, 50, 100}) measure(threads, options.quick ? 30 : 300);
                    });

}  // namespace
}  // namespace bench
