// A shooting range: a world of two Objects that fly for a tick, with an exact account of the expected events.
//
// Objects move one after another, the older one first. A swept Object is tested against the other one where
// that is during this turn. So it must not pass through anything on its own path, which is checked exactly
// for every turn of every swept Object. The two never move at once: the first may pass before the second
// starts, so they may miss each other where simultaneous movers would have hit (`simultaneous` counts these
// cases). But they cannot change sides within a corridor: if their extents on one axis overlap at the start,
// after the first turn and after the second, they also do in between, and then their order on the other axis
// must not change without a collision. This is checked, too, without computing times.
#pragma once

#include <cstdint>

#include "engine/world/Object.h"
#include "engine/world/World.h"
#include "shared/values/Fixed.h"
#include "tests/server/engine/oracle/OracleMask.h"

namespace bench {

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

class Shooter;

class Range {
 public:
  /// Makes two Objects. The older one moves first in each tick.
  Range(const Make& older, const Make& younger);
  ~Range();

  /// Makes all moves of the world swept (WM.setSweptCollisions), whatever the Objects' own settings are.
  void sweepAll();
  /// Puts both Objects at their start positions.
  void set(const Flier& older, const Flier& younger);
  /// Judges unswept Objects, too, from now on, but only by the reported collisions, not by where they stop.
  void judgeUnswept() { m_judge_unswept = true; }
  /// Runs a tick from the present positions and adds it to the account.
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
  Shooter* m_p_shooters[2];  // owned by the world
  bool m_judge_unswept = false;
};

/// True if the two overlap now, so that the rules for the start of a move would apply.
bool areMet(const Flier& a, const Flier& b);

}  // namespace bench
