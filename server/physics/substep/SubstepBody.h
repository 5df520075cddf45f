// A body of a SubstepWorld, with what is known of it from step to step.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "physics/geometry/ConvexShape.h"
#include "physics/rigid/RigidBody.h"

namespace naiad::physics {

/// A body within a step. Its velocity at the start of the step is not in it.
struct alignas(32) SubstepState {
  float vx = 0, vy = 0;  ///< velocity gained since the step began
  float spin = 0;        ///< rad per tick
  float unused = 0;
  float x = 0, y = 0;  ///< displacement, less the one at the velocity of the start
  float c = 1, s = 0;  ///< rotation since the step began
};

/// What a sub-step of acceleration adds to a state.
struct SubstepKick {
  float x = 0, y = 0;
  float spin = 0;
  float unused = 0;
};

// What a pair is examined by comes first, then what its rows are made of: each of them is read for every
// pair, and bodies are many more than fit into a cache.
struct alignas(64) SubstepBody {
  RigidBody body;
  double reach = 0;        ///< of all shapes, from the centre
  double thickness = 0;    ///< the least half width of a shape
  double margin = 0;       ///< how far around it contacts are searched for in this step
  double push = 0;         ///< how far the speed takes it that the last step's pushes gave, corners included
  double roll = 0;         ///< how far its spin moves a corner in this step
  Bounds box = {};         ///< around its shapes at the start of the step
  Vec2 drift;              ///< its displacement in this step if nothing pushes it
  std::int32_t state = 0;  ///< within a step; 0: nothing moves it
  std::uint32_t version = 0;
  std::uint64_t colours = 0, held_colours = 0;  ///< of its contacts in this step
  SubstepKick kick;
  float inverse_mass = 0, inverse_inertia = 0;  ///< in this step
  float pull = 0;                               ///< of joints, times the sub-step squared
  bool is_busy = true;                          ///< it hardly moves, or something pushed it in the last step
  bool exists = false, is_asleep = false, is_frozen = false;
  bool is_changed = false;   ///< it cannot be moved, and was set or removed since the last step
  bool is_shaken = false;    ///< in this step it meets something fast, or overlaps something by much
  bool is_diverted = false;  ///< in this step another fast body changed its path
  bool is_stopped = false;   ///< in a step of this tick it was, or was diverted
  double turn = 0;           ///< rad, in this step
  double part = 1;           ///< of its motion in this step: less than 1 if it is stopped
  double still = 0;          ///< ticks
  double first_speed = 0;    ///< when it began to be still
  std::int32_t ring = -1;    ///< the next body that fell asleep with it
  std::int32_t proxy = -1;   ///< in the broad phase
  std::uint64_t order = 0;
  std::int64_t pushed_at = -1;       ///< in which step something pushed it last
  std::int32_t form = -1;            ///< its shapes
  std::uint32_t turned_version = 0;  ///< which `version` of them `turned` was made of …
  Rotation turned_at;                ///< … and for which rotation
  std::vector<Vec2> turned;          ///< corners
  Bounds bounds = {};                ///< of these
};

/// An inverse mass or inertia as rows take it: impulses stay finite, which is why no row can spoil what
/// cannot move and is in other rows, too.
inline float inverseOf(double inverse) {
  return inverse > 0 ? static_cast<float>(std::fmax(inverse, 1e-25)) : 0;
}

inline bool isMovable(const SubstepBody& b) {
  return isMovable(b.body);
}

}  // namespace naiad::physics
