// The cost of finding the first obstacle on a way, compared with Box2D's ray cast. Every result is compared
// with the exact one.
//
// A 1×1 box is put somewhere (setPosition), and WM.firstContact finds the first obstacle within `speed`
// cells. kind=move: the box is moved there (WM.moveObject), swept, receives events, and stops at the
// obstacle. Box2D only finds the obstacle; its tree does not contain the mover.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "Casts.h"
#include "Contest.h"
#include "ElapsedTime.h"
#include "ResultLine.h"
#include "Suite.h"
#include "engine/managers/WorldManager.h"
#include "engine/world/EventCollision.h"
#include "engine/world/Object.h"
#include "shared/values/SplitMix64.h"
#include "tests/server/engine/oracle/OracleGeometry.h"
#include "tests/support/LoggedWorld.h"

namespace bench {
namespace {

df::Fixed fixed(double cells) {
  return std::llrint(cells * static_cast<double>(df::kFixedOne));
}

df::FixedVector randomPlace(double side, naiad::SplitMix64& random) {
  const double x = side * random.unit();
  const double y = side * random.unit();
  return {fixed(x), fixed(y)};
}

constexpr df::FixedBox kUnit{{-df::kFixedOne / 2, -df::kFixedOne / 2}, {df::kFixedOne, df::kFixedOne}};

std::vector<df::FixedBox> scatter(int n, double side) {
  naiad::SplitMix64 random(20240607);
  std::vector<df::FixedBox> boxes(static_cast<std::size_t>(n));
  for (df::FixedBox& box : boxes) box = translate(kUnit, randomPlace(side, random));
  return boxes;
}

bool isFree(const Field& field, const df::FixedBox& box) {
  bool is_free = true;
  field.sorted.near(box, [&](std::uint32_t i) {
    if (oracle::boxIntersectsBox(box, field.obstacles[i])) is_free = false;
  });
  return is_free;
}

bool isInside(const Field& field, df::FixedVector place) {
  const df::Fixed side = fixed(field.side);
  return place.x >= 0 && place.x < side && place.y >= 0 && place.y < side;
}

// Returns this many casts of `length` cells from random places in random directions. None touches an
// obstacle at its start. If the field is wider than twice the length, none leaves it.
std::vector<Cast> drawCasts(const Field& field, int count, double length) {
  naiad::SplitMix64 random(17);
  std::vector<Cast> casts(static_cast<std::size_t>(count));
  const bool has_room = field.side > 2 * length;
  for (Cast& cast : casts) {
    do {
      cast.from = randomPlace(field.side, random);
      const double angle = 2 * std::numbers::pi * random.unit();
      cast.to = cast.from + df::FixedVector{fixed(length * std::cos(angle)), fixed(length * std::sin(angle))};
    } while (!isFree(field, translate(kUnit, cast.from)) || (has_room && !isInside(field, cast.to)));
  }
  return casts;
}

// Returns the exact answer from all obstacles near the path.
Answer solve(const Field& field, const Cast& cast) {
  const oracle::SweepPath path{cast.from, cast.to};
  const df::FixedVector way = cast.to - cast.from;
  df::FixedBox area = translate(kUnit, {std::min(cast.from.x, cast.to.x), std::min(cast.from.y, cast.to.y)});
  area.size = {df::kFixedOne + std::abs(way.x), df::kFixedOne + std::abs(way.y)};
  Answer answer{kNobody, 1, cast.to};
  oracle::Time first{2, 1};
  field.sorted.near(area, [&](std::uint32_t i) {
    const std::optional<oracle::Time> time = oracle::firstTouch(path, kUnit, field.obstacles[i]);
    if (!time || first < *time || (!(*time < first) && answer.who < i)) return;
    first = *time;
    answer = {i, time->toDouble(), path.before(*time)};
  });
  return answer;
}

// True if the obstacles and final positions are equal, and the times differ by at most 1e-9 of the whole way.
bool areEqual(const Answer& a, const Answer& b) {
  return a.who == b.who && std::abs(a.time - b.time) <= 1e-9 && a.position == b.position;
}

/// Records the first Object with which it collides.
class Runner : public df::Object {
 public:
  int eventHandler(const df::Event* p_e) override {
    if (p_e->getType() != df::COLLISION_EVENT) return 0;
    const auto* p_collision = static_cast<const df::EventCollision*>(p_e);
    if (m_p_met == nullptr) m_p_met = p_collision->getObject2();
    return 1;
  }

  const df::Object* takeMet() { return std::exchange(m_p_met, nullptr); }

 private:
  const df::Object* m_p_met = nullptr;
};

df::FixedVector exactly(df::Vector v) {
  return df::toFixed(v).value_or(df::FixedVector{});
}

/// A field of obstacles in this project's engine, and the runner that is sent through it.
class Course {
 public:
  explicit Course(const Field& field) {
    WM.setBoundary(df::Box(df::Vector(-1e5, -1e5), 1e6, 1e6));
    for (const df::FixedBox& box : field.obstacles) {
      auto* p_obstacle = new df::Object;
      if (m_first_id == 0) m_first_id = p_obstacle->getId();
      const df::FixedVector middle = {box.corner.x + box.size.x / 2, box.corner.y + box.size.y / 2};
      p_obstacle->setPosition(df::Vector::fromFixed(middle));
    }
    m_p_runner = new Runner;
    m_p_runner->setSwept();
  }

  /// Puts the runner at the start of the cast.
  void place(const Cast& cast) { m_p_runner->setPosition(df::Vector::fromFixed(cast.from)); }
  /// Places the runner and returns its first contact (WM.firstContact).
  Answer ask(const Cast& cast) {
    place(cast);
    const df::Contact contact = WM.firstContact(m_p_runner, df::Vector::fromFixed(cast.to));
    return {numberOf(contact.p_object), contact.time, exactly(contact.position)};
  }
  /// Places the runner and moves it (WM.moveObject), swept. Returns the Object that it hit and where it
  /// stopped, but not the time, which moves do not report.
  Answer move(const Cast& cast) {
    place(cast);
    WM.moveObject(m_p_runner, df::Vector::fromFixed(cast.to));
    return {numberOf(m_p_runner->takeMet()), 0, exactly(m_p_runner->getPosition())};
  }
  /// True if the ordinary test, only at the end of the way, finds a collision.
  bool isBlockedAtEnd(const Cast& cast) {
    place(cast);
    return WM.isCollision(m_p_runner, df::Vector::fromFixed(cast.to));
  }

 private:
  std::uint32_t numberOf(const df::Object* p_object) const {
    return p_object == nullptr ? kNobody : static_cast<std::uint32_t>(p_object->getId() - m_first_id);
  }

  df::test::LoggedWorld m_own;
  int m_first_id = 0;  // id of the first obstacle; further ones have the next ids
  Runner* m_p_runner;  // owned by the world
};

enum class Kind { FIRST, MOVE };

template <class Do>
double nanosecondsPerCast(const std::vector<Cast>& casts, Do run) {
  const double begin = cpuNanoseconds();
  for (std::size_t i = 0; i < casts.size(); ++i) run(i);
  return (cpuNanoseconds() - begin) / static_cast<double>(casts.size());
}

// All results and times of one case.
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
  for (int i = 0; i <= repetitions; ++i) {  // the first repetition is a warm-up
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

Field::Field(int n, double density)
    : side(std::ceil(std::sqrt(n / density))), obstacles(scatter(n, side)), sorted(obstacles, 1) {}

}  // namespace bench
