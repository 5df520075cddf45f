// What it costs to look along a way for the first obstacle, against Box2D's ray cast, and whether the answer
// is right: every cast is compared with the exact one.
//
// A 1×1 box is put somewhere (setPosition) and asked whom it would meet `speed` cells further on
// (WM.firstContact). kind=move: it moves there (WM.moveObject), swept, hears, and stops. Box2D only answers
// the question; its tree need not be told of the mover.
#include <string>
#include <vector>

#include "Casts.h"
#include "Contest.h"
#include "Course.h"
#include "ElapsedTime.h"
#include "ResultLine.h"
#include "Suite.h"
#include "peers/Box2dCasts.h"

namespace bench {

namespace {

enum class Kind { FIRST, MOVE };

template <class Do>
double nanosecondsPerCast(const std::vector<Cast>& casts, Do run) {
  const double begin = cpuNanoseconds();
  for (std::size_t i = 0; i < casts.size(); ++i) run(i);
  return (cpuNanoseconds() - begin) / static_cast<double>(casts.size());
}

// Everything that has been asked in one case, and how long it took.
struct Result {
  std::vector<Answer> ours;
  std::vector<Answer> box2d;
  std::vector<double> ns;
  std::vector<double> box2d_ns;
  std::vector<double> placing_ns;
};

Result run(Kind kind, Course& course, const Box2dCasts& box2d, const std::vector<Cast>& casts,
           int repetitions) {
  Result result;
  result.ours.resize(casts.size());
  result.box2d.resize(casts.size());
  for (int i = 0; i <= repetitions; ++i) {  // the first one is to warm up
    const double ns = nanosecondsPerCast(casts, [&](std::size_t c) {
      result.ours[c] = kind == Kind::FIRST ? course.ask(casts[c]) : course.move(casts[c]);
    });
    const double box2d_ns =
        nanosecondsPerCast(casts, [&](std::size_t c) { result.box2d[c] = box2d.cast(casts[c]); });
    const double placing_ns = nanosecondsPerCast(casts, [&](std::size_t c) { course.place(casts[c]); });
    if (i == 0) continue;
    result.ns.push_back(ns);
    result.box2d_ns.push_back(box2d_ns);
    result.placing_ns.push_back(placing_ns);
  }
  return result;
}

struct Case {
  int n;
  double density;
  double speed;
  Kind kind;
};

void report(const Case& c, const Field& field, Course& course, const std::vector<Cast>& casts,
            const Result& result) {
  long mismatches = 0;
  long hits = 0;
  long agrees = 0;
  long missed_at_end = 0;
  for (std::size_t i = 0; i < casts.size(); ++i) {
    const Answer right = solve(field, casts[i]);
    Answer ours = result.ours[i];
    if (c.kind == Kind::MOVE) ours.time = right.time;
    if (!areEqual(ours, right)) ++mismatches;
    if (result.box2d[i].who == right.who) ++agrees;
    if (right.who == kNobody) continue;
    ++hits;
    if (!course.isBlockedAtEnd(casts[i])) ++missed_at_end;
  }
  const auto count = static_cast<double>(casts.size());
  Line line("sweep");
  line.add("n", c.n).add("speed", c.speed).add("density", c.density);
  line.add("kind", c.kind == Kind::FIRST ? "first" : "move");
  line.add("ns_per_sweep", median(result.ns));
  line.add("box2d_ratio", median(result.box2d_ns) / median(result.ns));
  line.addZero("mismatches", mismatches);
  line.add("casts", static_cast<long long>(casts.size()));
  line.add("hits_percent", 100 * static_cast<double>(hits) / count);
  line.add("placing_ns", median(result.placing_ns)).add("box2d_ns", median(result.box2d_ns));
  line.add("box2d_agrees_percent", 100 * static_cast<double>(agrees) / count);
  if (hits > 0) {
    line.add("end_test_misses_percent", 100 * static_cast<double>(missed_at_end) / static_cast<double>(hits));
  }
}

void measure(int n, double density, bool with_moves, const Options& options) {
  progress("sweep: " + std::to_string(n) + " at density " + std::to_string(density));
  const Field field(n, density);
  const Box2dCasts box2d(field);
  Course course(field);
  for (const Kind kind : {Kind::FIRST, Kind::MOVE}) {
    if (kind == Kind::MOVE && !with_moves) continue;
    for (const double speed : {0.5, 2.0, 8.0, 32.0, 128.0}) {
      const std::vector<Cast> casts = drawCasts(field, options.quick ? 2000 : 30'000, speed);
      const Result result = run(kind, course, box2d, casts, options.quick ? 3 : 5);
      report({n, density, speed, kind}, field, course, casts, result);
    }
  }
}

const Suite s_suite("sweep", "finding the first obstacle on a way, against Box2D's ray cast",
                    [](const Options& options) {
                      for (const double density : {0.1, 0.01}) {
                        for (const int n : {1000, 10'000, 100'000}) {
                          if (options.quick && (n > 1000 || density < 0.1)) continue;
                          const bool with_moves = density == 0.1 && (options.quick || n == 100'000);
                          measure(n, density, with_moves, options);
                        }
                      }
                    });

}  // namespace

}  // namespace bench
