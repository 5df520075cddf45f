// Where shots are fired: a world of two Objects that fly through a tick, and the exact account of what should
// have happened.
//
// Objects move one after another, the older first, and a swept one is tested against the other where it is at
// that turn. So its own path in the tick is what it must not pass through anything on: that is asked of every
// turn of every swept Object, exactly. Two that move in one tick never are where a clock would see them both
// half-way; what two clocked movers would have hit, two sequential ones may go around, when the first is past
// before the second begins (`simultaneous` counts those). But they cannot change sides within a corridor: if
// their extents on one axis overlap at the start, after the first turn and after the second, then they do in
// between, too, and their order on the other axis must not change without a collision. That is asked besides,
// without any times.
#pragma once

#include <cstdint>
#include <optional>

#include "Glyphs.h"
#include "Impact.h"
#include "engine/world/Object.h"
#include "engine/world/World.h"
#include "shared/values/Fixed.h"

namespace bench {

/// One of the two, as it is before a tick.
struct Flier {
  df::FixedBox box;  ///< relative to the position
  df::FixedVector position;
  df::FixedVector velocity;
  std::optional<Glyphs> glyphs;  ///< if it is precise

  df::FixedBox boxAt(df::FixedVector at) const { return df::translate(box, at); }
};

/// How an Object is made; all shots of a pair share it.
struct Make {
  df::Solidness solidness = df::HARD;
  bool no_soft = false;
  bool swept = true;
};

struct Account {
  long shots = 0;    ///< ticks in which something was fired
  long hits = 0;     ///< in which some swept turn had to meet the other
  long through = 0;  ///< in which it was not reported to both, or a blocking one did not stop just before
  long ghosts = 0;   ///< in which a swept turn met or stopped, and had no reason to
  long simultaneous = 0;  ///< nobody met anybody, but two clocked movers would have
};

class Shooter;

class Range {
 public:
  /// `older` and `younger`, by the order of their turns.
  Range(const Make& older, const Make& younger);
  ~Range();

  /// All moves of the world are swept, whatever its Objects say (WM.setSweptCollisions).
  void sweepAll();
  /// Put both where they begin.
  void set(const Flier& older, const Flier& younger);
  /// Judge unswept ones, too, but only by whether they are told of whom they meet on the way. (Else nobody
  /// minds where they go.)
  void judgeUnswept() { m_judge_unswept = true; }
  /// A tick from where they are now, accounted for.
  void tick(Account& account);

 private:
  struct Turn;

  Turn turnOf(int mover, const df::FixedVector* p_before, const df::FixedVector* p_after) const;
  bool haveSwapped(const df::FixedVector* p_before, const df::FixedVector* p_after) const;
  bool block(int mover) const;

  df::World m_world;
  df::World::Scope m_scope;
  Make m_makes[2];
  Flier m_fliers[2];
  Shooter* m_p_shooters[2];  // the world's
  bool m_judge_unswept = false;
};

/// Do the two share a place where they are, so that the rules for the start of a move would apply?
bool areMet(const Flier& a, const Flier& b);

}  // namespace bench
