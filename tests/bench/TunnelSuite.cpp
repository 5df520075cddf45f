// Tests that nothing passes through anything: a million shots at all kinds of targets, in random directions,
// at speeds from a tenth of a cell to a million cells per second, and some at up to a million cells per tick.
// Range defines what counts as a hit and as passing through.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <utility>

#include "RandomMask.h"
#include "ResultLine.h"
#include "Suite.h"
#include "engine/managers/WorldManager.h"
#include "engine/world/EventCollision.h"
#include "engine/world/Object.h"
#include "shared/values/Fixed.h"
#include "shared/values/SplitMix64.h"
#include "tests/server/engine/oracle/OracleGeometry.h"
#include "tests/support/LoggedWorld.h"

namespace bench {
namespace {

using naiad::SplitMix64;

/// One of the two Objects before a tick.
struct Flier {
  df::FixedBox box;  ///< box relative to the position
  df::FixedVector position;
  df::FixedVector velocity;
  oracle::Mask mask;  ///< the characters if the Object is precise, otherwise empty

  df::FixedBox boxAt(df::FixedVector at) const { return df::translate(box, at); }
};

/// Properties of an Object, used for all shots of a pair.
struct Make {
  df::Solidness solidness = df::HARD;
  bool no_soft = false;
  bool swept = true;
};

struct Account {
  long shots = 0;         ///< ticks in which an Object was fired
  long hits = 0;          ///< ticks in which a swept turn had to hit the other Object
  long through = 0;       ///< ticks with a hit that was not reported to both, or with no stop before it
  long ghosts = 0;        ///< ticks in which a swept turn reported a hit or stopped without reason
  long simultaneous = 0;  ///< ticks without a hit in which two simultaneous movers would have hit
};

// Returns the first time at which the mover collides with the other Object.
std::optional<oracle::Time> meeting(const oracle::SweepPath& path, const Flier& own,
                                    const df::FixedBox& obstacle, const Flier& other) {
  if (own.mask.empty() || other.mask.empty()) return oracle::firstTouch(path, own.box, obstacle);
  return oracle::firstShare(path, own.box, own.mask, obstacle, other.mask);
}

/// Counts its collision events: separately those in which it moved and those in which it was hit.
class Shooter : public df::Object {
 public:
  explicit Shooter(const Make& make) {
    setSolidness(make.solidness);
    setNoSoft(make.no_soft);
    setSwept(make.swept);
  }

  int eventHandler(const df::Event* p_e) override {
    if (p_e->getType() != df::COLLISION_EVENT) return 0;
    const auto* p_collision = static_cast<const df::EventCollision*>(p_e);
    ++(p_collision->getObject1() == this ? as_mover : as_other);
    return 1;
  }

  int as_mover = 0;
  int as_other = 0;
};

/// A shooting range: a world of two Objects that fly for a tick, with an exact account of the expected
/// events.
///
/// Objects move one after another, the older one first, while the other one stands still. A swept Object
/// must not pass through anything on its own path. This is checked exactly for each move of each swept
/// Object. Because the two do not move simultaneously, they may miss each other where simultaneous movers
/// would collide (`simultaneous` counts these cases). But they cannot change sides within a corridor: if
/// their extents on one axis overlap at the start, after the first move and after the second, they also do in
/// between, and then their order on the other axis must not change without a collision. This is checked, too;
/// it requires no times of impact.
class Range {
 public:
  /// Makes two Objects. The older one moves first in each tick.
  Range(const Make& older, const Make& younger) : m_makes{older, younger} {
    WM.setBoundary(df::Box(df::Vector(-1e6, -1e6), 1e6, 1e6));
    for (int i : {0, 1}) m_p_shooters[i] = new Shooter(m_makes[i]);
  }

  /// Makes all moves of the world swept (WM.setSweptCollisions), whatever the Objects' own settings are.
  void sweepAll() {
    WM.setSweptCollisions();
    for (Make& make : m_makes) make.swept = true;
  }
  /// Puts both Objects at their start positions.
  void set(const Flier& older, const Flier& younger) {
    m_fliers[0] = older;
    m_fliers[1] = younger;
    for (int i : {0, 1}) {
      const df::FixedBox& box = m_fliers[i].box;
      m_p_shooters[i]->setBox(
          {df::Vector::fromFixed(box.corner), df::toCells(box.size.x), df::toCells(box.size.y)});
      m_p_shooters[i]->setPosition(df::Vector::fromFixed(m_fliers[i].position));
      m_p_shooters[i]->setVelocity(df::Vector::fromFixed(m_fliers[i].velocity));
      if (m_fliers[i].mask.empty()) continue;
      m_p_shooters[i]->setMask(m_fliers[i].mask);
      m_p_shooters[i]->setPrecise();
    }
  }
  /// Judges unswept Objects, too, from now on, but only by the reported collisions, not by where they stop.
  void judgeUnswept() { m_judge_unswept = true; }
  /// Runs a tick from the present positions and adds it to the account.
  void tick(Account& account) {
    df::FixedVector before[2];
    df::FixedVector after[2];
    for (int i : {0, 1}) {
      before[i] = m_fliers[i].position;
      m_p_shooters[i]->as_mover = m_p_shooters[i]->as_other = 0;
    }
    WM.update();
    for (int i : {0, 1}) {
      after[i] = df::toFixed(m_p_shooters[i]->getPosition()).value_or(df::FixedVector{});
      m_fliers[i].position = after[i];
    }

    bool hit = false;
    bool through = false;
    bool ghost = false;
    for (int i : {0, 1}) {
      if ((!m_makes[i].swept && !m_judge_unswept) || m_fliers[i].velocity == df::FixedVector{}) continue;
      const Turn turn = turnOf(i, before, after);
      hit |= turn.must_meet;
      if (!turn.is_right) (turn.must_meet ? through : ghost) = true;
    }
    const bool solid = m_fliers[0].mask.empty();  // shots may fly through holes
    const bool all_swept = m_makes[0].swept && m_makes[1].swept;
    const bool told = m_p_shooters[0]->as_mover + m_p_shooters[1]->as_mover > 0;
    if (solid && all_swept && !told && haveSwapped(before, after)) through = true;
    ++account.shots;
    account.hits += hit ? 1 : 0;
    account.through += through ? 1 : 0;
    account.ghosts += ghost ? 1 : 0;
    if (all_swept && !told) {
      const oracle::SweepPath relative{before[0], before[0] + m_fliers[0].velocity - m_fliers[1].velocity};
      if (meeting(relative, m_fliers[0], m_fliers[1].boxAt(before[1]), m_fliers[1])) ++account.simultaneous;
    }
  }

 private:
  /// Expectation and result of one turn.
  struct Turn {
    bool must_meet;
    bool is_right;
  };

  Turn turnOf(int mover, const df::FixedVector* p_before, const df::FixedVector* p_after) const {
    const int other = 1 - mover;
    const Flier& own = m_fliers[mover];
    const Flier& its = m_fliers[other];
    const df::FixedBox obstacle = its.boxAt(mover == 0 ? p_before[other] : p_after[other]);
    const oracle::SweepPath path{p_before[mover], p_before[mover] + own.velocity};
    const std::optional<oracle::Time> time = meeting(path, own, obstacle, its);
    const df::FixedVector end = time && block(mover) ? path.before(*time) : path.to;
    const int expected = time ? 1 : 0;
    const bool is_told =
        m_p_shooters[mover]->as_mover == expected && m_p_shooters[other]->as_other == expected;
    return {time.has_value(), is_told && (!m_makes[mover].swept || p_after[mover] == end)};
  }
  bool haveSwapped(const df::FixedVector* p_before, const df::FixedVector* p_after) const {
    const df::FixedBox begin[2] = {m_fliers[0].boxAt(p_before[0]), m_fliers[1].boxAt(p_before[1])};
    const df::FixedBox end[2] = {m_fliers[0].boxAt(p_after[0]), m_fliers[1].boxAt(p_after[1])};
    const auto along = [&](df::Fixed df::FixedVector::*axis, df::Fixed df::FixedVector::*cross) {
      const auto overlap = [cross](const df::FixedBox& a, const df::FixedBox& b) {
        return a.corner.*cross <= b.corner.*cross + b.size.*cross &&
               b.corner.*cross <= a.corner.*cross + a.size.*cross;
      };
      const auto isBehind = [axis](const df::FixedBox& a, const df::FixedBox& b) {
        return a.corner.*axis + a.size.*axis < b.corner.*axis;
      };
      if (!overlap(begin[0], begin[1]) || !overlap(end[0], begin[1]) || !overlap(end[0], end[1]))
        return false;
      return (isBehind(begin[0], begin[1]) && isBehind(end[1], end[0])) ||
             (isBehind(begin[1], begin[0]) && isBehind(end[0], end[1]));
    };
    return along(&df::FixedVector::x, &df::FixedVector::y) || along(&df::FixedVector::y, &df::FixedVector::x);
  }
  bool block(int mover) const {
    const Make& own = m_makes[mover];
    const Make& its = m_makes[1 - mover];
    if (its.solidness == df::SOFT) return own.no_soft;
    return own.solidness == df::HARD && its.solidness == df::HARD;
  }

  df::test::LoggedWorld m_own;
  Make m_makes[2];
  Flier m_fliers[2];
  Shooter* m_p_shooters[2];  // owned by the world
  bool m_judge_unswept = false;
};

// True if the two overlap now, so that the rules for the start of a move would apply.
bool areMet(const Flier& a, const Flier& b) {
  const df::FixedBox a_box = a.boxAt(a.position);
  const df::FixedBox b_box = b.boxAt(b.position);
  if (!oracle::boxIntersectsBox(a_box, b_box)) return false;
  return a.mask.empty() || b.mask.empty() || oracle::shareCell(a_box, a.mask, b_box, b.mask);
}

enum class Shape {
  UNIT,    ///< 1×1
  SPRITE,  ///< 3×2 to 12×4, all cells set
  GLYPHS,  ///< 3×2 to 12×4 characters with holes, precise
  THIN,    ///< 0.01×8 or 8×0.01
  NEEDLE,  ///< 0.01×0.01
  WALL,    ///< 10,000×1 or 1×10,000
};

enum class Motion {
  REST,     ///< the older one rests, the younger one flies towards it
  FIRES,    ///< the older one flies, the younger one rests
  BOTH,     ///< both fly in any direction
  HEAD_ON,  ///< both fly along an axis towards each other, almost straight
};

/// The kinds of two Objects and how they move. The older Object moves first.
struct Pairing {
  const char* name;
  Shape older;
  Shape younger;
  Motion motion = Motion::REST;
  Make make_older{};
  Make make_younger{};
  int ticks = 1;     ///< ticks of a shot, which determine its initial distance
  double speed = 0;  ///< cells per tick; 0: random
};

constexpr double kTicksPerSecond = 30;
constexpr double kFastPart = 0.1;  // share of shots faster than a million cells per second
constexpr double kFieldSide = 1000;

df::Fixed fixed(double cells) {
  return std::llrint(cells * static_cast<double>(df::kFixedOne));
}

double between(double least, double most, SplitMix64& random) {
  return least + (most - least) * random.unit();
}

double logarithmicallyBetween(double least, double most, SplitMix64& random) {
  return std::exp(between(std::log(least), std::log(most), random));
}

df::FixedBox boxOf(double width, double height) {
  return {{-fixed(width) / 2, -fixed(height) / 2}, {fixed(width), fixed(height)}};
}

Flier shape(Shape shape, SplitMix64& random) {
  Flier flier;
  double width = 1;
  double height = 1;
  if (shape == Shape::SPRITE || shape == Shape::GLYPHS) {
    const oracle::Mask mask = randomMask(random);
    width = static_cast<double>(mask[0].size());
    height = static_cast<double>(mask.size());
    if (shape == Shape::GLYPHS) flier.mask = mask;
  }
  if (shape == Shape::THIN || shape == Shape::NEEDLE) width = 0.01;
  if (shape == Shape::NEEDLE) height = 0.01;
  if (shape == Shape::THIN) height = 8;
  if (shape == Shape::WALL) width = 10'000;
  if (shape != Shape::GLYPHS && random.below(2) == 0) std::swap(width, height);
  flier.box = boxOf(width, height);
  return flier;
}

// Draws the speed of a shot, in cells per tick. The highest speeds are drawn only for shots of one tick,
// because positions are read as doubles.
double drawSpeed(const Pairing& pairing, SplitMix64& random) {
  if (pairing.speed > 0) return pairing.speed;
  const double usual = 1e6 / kTicksPerSecond;
  if (pairing.ticks == 1 && random.unit() < kFastPart) return logarithmicallyBetween(usual, 1e6, random);
  return logarithmicallyBetween(0.1 / kTicksPerSecond, usual, random);
}

df::FixedVector drawVelocity(const Pairing& pairing, SplitMix64& random) {
  const double speed = drawSpeed(pairing, random);
  const double angle = 2 * std::numbers::pi * random.unit();
  return {fixed(speed * std::cos(angle)), fixed(speed * std::sin(angle))};
}

void chooseVelocities(const Pairing& pairing, Flier& older, Flier& younger, SplitMix64& random) {
  if (pairing.motion != Motion::REST) older.velocity = drawVelocity(pairing, random);
  if (pairing.motion != Motion::FIRES) younger.velocity = drawVelocity(pairing, random);
  if (pairing.motion != Motion::HEAD_ON) return;
  const df::Fixed ahead = fixed(drawSpeed(pairing, random));
  const df::Fixed against = fixed(drawSpeed(pairing, random));
  const df::Fixed aside = fixed(between(-0.3, 0.3, random));
  older.velocity = {ahead, aside};
  younger.velocity = {-against, fixed(between(-0.3, 0.3, random))};
  if (random.below(2) == 0) return;
  for (Flier* p_flier : {&older, &younger}) std::swap(p_flier->velocity.x, p_flier->velocity.y);
}

// Draws a position of the younger Object relative to the older one at which the two touch, mostly just
// barely.
df::FixedVector drawContact(const Flier& older, const Flier& younger, SplitMix64& random) {
  const double reach_x = df::toCells(older.box.size.x + younger.box.size.x) / 2;
  const double reach_y = df::toCells(older.box.size.y + younger.box.size.y) / 2;
  double x = between(-1, 1, random);
  double y = between(-1, 1, random);
  (random.below(2) == 0 ? x : y) = random.below(2) == 0 ? 1 : -1;
  const double depth = random.unit() < 0.6 ? 1 : between(0, 1.1, random);
  return {fixed(depth * x * reach_x), fixed(depth * y * reach_y)};
}

df::FixedVector times(df::FixedVector v, double factor) {
  return {fixed(df::toCells(v.x) * factor), fixed(df::toCells(v.y) * factor)};
}

/// Draws a shot: places the two so that they touch at a moment of the first turn, of the second, or of a
/// flight in which both move at once, and do not touch at the start.
void aim(const Pairing& pairing, Flier& older, Flier& younger, SplitMix64& random) {
  do {
    older = shape(pairing.older, random);
    younger = shape(pairing.younger, random);
    chooseVelocities(pairing, older, younger, random);
    const double x = between(-kFieldSide, kFieldSide, random);
    const double y = between(-kFieldSide, kFieldSide, random);
    older.position = {fixed(x), fixed(y)};
    const double time = random.unit() * std::max(1, pairing.ticks - 2);
    double older_gone = time;
    double younger_gone = time;
    if (pairing.motion == Motion::BOTH || pairing.motion == Motion::HEAD_ON) {
      const std::uint64_t moment = random.below(3);
      if (moment == 0) younger_gone = 0;
      if (moment == 1) older_gone = 1;
    }
    younger.position = older.position + times(older.velocity, older_gone) -
                       times(younger.velocity, younger_gone) + drawContact(older, younger, random);
  } while (areMet(older, younger));
}

Account fire(const Pairing& pairing, long shots, bool all_swept) {
  Range range(pairing.make_older, pairing.make_younger);
  if (all_swept) range.sweepAll();
  if (pairing.speed > 0) range.judgeUnswept();
  SplitMix64 random(20240607);
  Account account;
  Flier older;
  Flier younger;
  while (account.shots < shots) {
    aim(pairing, older, younger, random);
    range.set(older, younger);
    for (int tick = 0; tick < pairing.ticks; ++tick) range.tick(account);
  }
  return account;
}

void measure(const Pairing& pairing, long shots) {
  const bool swept = pairing.speed == 0;
  const bool all_swept = std::string(pairing.name) == "all_swept";
  const Account account = fire(pairing, shots, all_swept);
  const auto percentOf = [](long part, long whole) {
    return 100 * static_cast<double>(part) / static_cast<double>(whole);
  };
  Line line("tunnel");
  line.add("pair", pairing.name).add("shots", static_cast<long long>(account.shots));
  if (swept) {
    line.addZero("through", account.through).addZero("ghosts", account.ghosts);
  } else {
    line.add("through", static_cast<long long>(account.through));
    line.add("through_percent", percentOf(account.through, account.hits)).add("speed", pairing.speed);
  }
  line.add("hits_percent", percentOf(account.hits, account.shots));
  if (pairing.motion == Motion::BOTH || pairing.motion == Motion::HEAD_ON) {
    line.add("simultaneous_only_percent", percentOf(account.simultaneous, account.shots));
  }
}

const Make kSoft{df::SOFT};
const Make kNoSoft{df::HARD, true};
const Make kUnswept{df::HARD, false, false};

const Pairing kPairings[] = {
    {"static", Shape::UNIT, Shape::UNIT},
    {"static_younger", Shape::UNIT, Shape::UNIT, Motion::FIRES},
    {"all_swept", Shape::UNIT, Shape::UNIT, Motion::BOTH, kUnswept, kUnswept},
    {"moving", Shape::UNIT, Shape::UNIT, Motion::BOTH, kUnswept},
    {"moving_younger", Shape::UNIT, Shape::UNIT, Motion::BOTH, {}, kUnswept},
    {"fast_fast", Shape::UNIT, Shape::UNIT, Motion::BOTH},
    {"head_on", Shape::UNIT, Shape::UNIT, Motion::HEAD_ON},
    {"soft", Shape::UNIT, Shape::UNIT, Motion::REST, kSoft},
    {"no_soft", Shape::UNIT, Shape::UNIT, Motion::REST, kSoft, kNoSoft},
    {"thin", Shape::THIN, Shape::UNIT},
    {"needle_thin", Shape::THIN, Shape::NEEDLE},
    {"needle_needle", Shape::NEEDLE, Shape::NEEDLE, Motion::BOTH},
    {"sprite", Shape::SPRITE, Shape::SPRITE},
    {"sprite_fast", Shape::SPRITE, Shape::SPRITE, Motion::BOTH},
    {"precise", Shape::GLYPHS, Shape::GLYPHS},
    {"precise_fast", Shape::GLYPHS, Shape::GLYPHS, Motion::BOTH},
    {"wall", Shape::WALL, Shape::UNIT},
    {"wall_needle", Shape::WALL, Shape::NEEDLE},
    {"wall_moves", Shape::WALL, Shape::UNIT, Motion::FIRES},
    {"wall_fast", Shape::WALL, Shape::WALL, Motion::BOTH},
    {"flight", Shape::UNIT, Shape::UNIT, Motion::REST, {}, {}, 8},
    {"flight_precise", Shape::GLYPHS, Shape::GLYPHS, Motion::REST, {}, {}, 8},
};

const Suite s_suite("tunnel", "does anything swept pass through anything? a million shots",
                    [](const Options& options) {
                      progress("tunnel");
                      const long shots = options.quick ? 3000 : 46'000;
                      for (const Pairing& pairing : kPairings) measure(pairing, shots);
                      for (const double speed : {0.5, 2.0, 8.0, 32.0, 128.0}) {
                        Pairing unswept{"static_unswept", Shape::UNIT, Shape::UNIT,
                                        Motion::REST,     {},          kUnswept};
                        unswept.speed = speed;
                        measure(unswept, shots);
                      }
                    });

}  // namespace
}  // namespace bench
