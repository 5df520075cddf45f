// Problem 25: heaps that fall, turn and are smashed, compared with Box2D. Problem 26: heaps that stand.
// Problem 27: bodies on hinges: a chain with a heavy end, and a net.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <string>
#include <vector>

#include "Problem.h"
#include "physics/Overlap.h"
#include "physics/Scenes.h"

namespace lab {
namespace {

double meanOf(const std::vector<double>& values) {
  return values.empty() ? 0 : std::accumulate(values.begin(), values.end(), 0.0) / std::ssize(values);
}

struct Seen {
  double overlap = 0;  ///< mean over all checks of the deepest overlap, m
  double lost = 0;     ///< largest number of lost bodies at any check or at the end
};

Seen watch(const Trial& trial, const Scene& scene) {
  Seen seen;
  std::vector<double> overlaps;
  trial.run(scene, [&](int tick, const Simulation& simulation) {
    const bool is_look = tick % kTicksPerLook == 0;
    if (is_look) overlaps.push_back(deepestOverlap(scene.bodies, statesOf(scene, simulation)));
    if (is_look || tick == scene.ticks)
      seen.lost = std::max(seen.lost, static_cast<double>(countLost(scene, simulation)));
  });
  seen.overlap = meanOf(overlaps);
  return seen;
}

struct Asked {
  double least_ratio = 1;  ///< minimum of Box2D's time divided by the fast level's
  double most_overlap = 0;
};

Case crowd(const std::string& name, const std::string& label, const Scene& scene) {
  Case its_case(name, label, scene);
  its_case.is_crowd = true;
  its_case.draws_levels = true;
  its_case.most_substeps = 16;
  return its_case;
}

Case heap(const std::string& name, const std::string& label, const Scene& scene, const Asked& asked) {
  Case its_case = crowd(name, label, scene);
  its_case.metrics = {{"overlap_m", "deepest overlap, mean of all looks, m", -1, 1e-15, asked.most_overlap},
                      {"lost", "bodies that froze or went through a wall", 0, 0, 0}};
  its_case.cpu_bounds = {{"cpu_ratio", "box2d", kBox2dSteps, 1, 1 / asked.least_ratio}};
  its_case.judge = [scene](const Trial& trial) {
    const Seen seen = watch(trial, scene);
    return std::vector<double>{seen.overlap, seen.lost};
  };
  return its_case;
}

Case drum() {
  Case turning = heap("tumbler500", "500 boxes in a drum that turns", makeTumbler500(), {3, .063});
  turning.metrics.push_back(
      {"five_drums_m", "the same, mean of five drums of 22.5 to 27.5 °/s, m", .016, 1e-15});
  turning.judge = [judge = turning.judge](const Trial& trial) {
    std::vector<double> errors = judge(trial), drums;
    for (const double degrees : {22.5, 23.75, 25.0, 26.25, 27.5}) {
      Scene scene = makeTumbler500();
      scene.bodies.front().spin = degrees * std::numbers::pi / 180;
      drums.push_back(watch(trial, scene).overlap);
    }
    errors.push_back(meanOf(drums));
    return errors;
  };
  return turning;
}

// A pyramid of 60 rows (1,830 boxes of 1 m) and a hundred of 10 rows, all touching exactly at the start, 14
// ticks; 500 boxes of 0.25 m in a drum of 19 m that turns by 25° a second, 5 s; 2,000 and 20,000 circles and
// boxes that fall between two walls, 100 and 40 ticks; a box of 8 m that flies at 40 m/s into 2,400 boxes of
// 0.4 m, 100 ticks. Friction 0.6. Bodies at rest may sleep, by each engine's default rules. The time is the
// mean of all ticks. Correct: nothing overlaps. The error is the deepest overlap of any pair after each tenth
// tick, as the mean of these samples.
std::vector<Case> makeHeaps() {
  Case large = heap("heap20000", "20,000 bodies that fall", makeHeap20000(), {2.5, .1});
  large.most_substeps = 4;
  large.long_run = true;
  return {heap("pyramids100", "a hundred pyramids of 10 rows", makePyramids100(), {10, .0048}),
          heap("pyramid60", "a pyramid of 60 rows", makePyramid60(), {7.5, .031}),
          heap("smash", "2,400 boxes that are smashed", makeSmash(), {10, .123}),
          large,
          drum(),
          heap("heap2000", "2,000 bodies that fall", makeHeap2000(), {2.5, .125})};
}

Case standing(int rows, double target, double fast_target) {
  constexpr int kTicks = 300;
  constexpr int kAsleep = 150;
  Case its_case = crowd(std::to_string(rows), std::to_string(rows) + " rows", makePyramid(rows));
  its_case.scene.ticks = kTicks;
  its_case.most_substeps = 8;
  its_case.long_run = rows > 30;
  its_case.metrics = {{"sinking_m", "how far the top has sunk after 10 s, m", target, 1e-15, fast_target},
                      {"stir_m", "largest motion after the fifth second, m", 0, 1e-15, 0}};
  its_case.judge = [own = its_case.scene](const Trial& trial) {
    const int count = static_cast<int>(own.bodies.size());
    std::vector<Vec> rest;
    const SimulationPtr end = trial.run(own, [&](int tick, const Simulation& simulation) {
      for (int i = 0; tick == kAsleep && i < count; ++i) rest.push_back(simulation.body(i).position);
    });
    double stir = 0;
    for (int i = 0; i < count; ++i)
      stir = std::max(stir, length(end->body(i).position - rest[static_cast<std::size_t>(i)]));
    const double sunk = end->body(count - 1).position.y - own.bodies.back().position.y;
    return std::vector<double>{std::abs(sunk), stir};
  };
  return its_case;
}

// Pyramids of 20, 30 and 60 rows of boxes of 1 m that touch exactly at the start, friction 0.6, 10 s. What
// rests may sleep. Correct: nothing moves: the top stays where it is, and after 5 s all of them sleep.
std::vector<Case> makeStanding() {
  return {standing(20, .033, .117), standing(30, .059, .26), standing(60, .059, .5)};
}

Case hanging(const std::string& name, const std::string& label, const Scene& scene) {
  Case its_case = crowd(name, label, scene);
  its_case.judge = [scene](const Trial& trial) {
    return trial.largest(scene, [&](int tick, const Simulation& simulation) {
      const bool is_look = tick % kTicksPerLook == 0;
      return std::vector<double>{is_look ? widestHinge(scene, statesOf(scene, simulation)) : 0,
                                 static_cast<double>(simulation.frozen())};
    });
  };
  return its_case;
}

std::vector<Metric> metrics(double target, double fast_target) {
  return {{"joint_error_m", "widest hinge at any look, m", target, 1e-15, fast_target},
          {"frozen", "bodies that froze", 0, 0, 0}};
}

Case chain() {
  Case swinging = hanging("chain100", "a chain of 20 links", makeChain100());
  swinging.metrics = metrics(1e-9, -1);
  swinging.cpu_bounds = {{"cpu_ratio", "box2d", kBox2dSteps, 2, -1}};
  return swinging;
}

Case net() {
  Case falling = hanging("grid100", "a net of 100 × 100 discs", makeGrid100());
  falling.metrics = metrics(-1, .35);
  falling.cpu_bounds = {
      {"cpu_ratio", "box2d", kBox2dSteps, 1, .5},
      {.name = "first_tick", .method = "", .target = 3, .fast_target = 3, .is_of_later = true}};
  falling.most_substeps = 8;
  return falling;
}

// Runs long enough for the net to fall as far as its hinges allow.
Case longNet() {
  constexpr int kTicks = 300;
  constexpr double kBounded = 2;  // m
  Scene scene = makeGrid100();
  scene.ticks = kTicks;
  Case falling = hanging("grid100_long", "the net for 10 s", scene);
  falling.metrics = metrics(kBounded, kBounded);
  falling.long_run = true;
  falling.draws_levels = false;
  falling.most_substeps = 4;
  return falling;
}

// 20 links of 1 × 0.25 m, hinged end to end and to the world, with a box of 100 times a link's mass at the
// free end, which falls from rest, 10 s; and a net of 100 × 100 discs that are hinged to their neighbours
// (19,800 hinges), of which seven in the middle of the top row are fixed, 1 s and 10 s. Nothing touches.
// Correct: the two points that a hinge holds together stay together.
std::vector<Case> makeHinges() {
  return {longNet(), net(), chain()};
}

const RegisteredProblem falling(
    "25", "heaps", makeHeaps, "Heaps beside Box2D",
    "Games with physics are games with heaps. The fast level is asked to be several times as fast as Box2D "
    "2.4.1 at the overlap that Box2D v3 leaves; the default level never to be slower than 2.4.1.");
const RegisteredProblem pyramids(
    "26", "pyramids", makeStanding, "Pyramids that stand",
    "What stands must come to rest, or it costs its full price for ever, and sends bytes to every player.");
const RegisteredProblem hinges("27", "hinges", makeHinges, "Chains and nets on hinges",
                               "A bridge, a chain and a net are what an author builds first with joints. "
                               "The chain is what a direct solution of trees is for; the net has 9,801 "
                               "loops, which is more than one can solve for directly in a tick.");

}  // namespace
}  // namespace lab
