// A body of a SubstepWorld, with the data kept from step to step.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "physics/geometry/ConvexShape.h"
#include "physics/rigid/RigidBody.h"

namespace naiad::physics {

/// A body within a step; the velocity at the start of the step is stored elsewhere (SubstepBody::body).
struct alignas(32) SubstepState {
  float vx = 0, vy = 0;  ///< velocity gained since the step began
  float spin = 0;        ///< rad per tick
  float unused = 0;
  float x = 0, y = 0;  ///< displacement minus that by the velocity at the start of the step
  float c = 1, s = 0;  ///< rotation since the step began
};

/// Change of a state by a sub-step of acceleration.
struct SubstepKick {
  float x = 0, y = 0;
  float spin = 0;
  float unused = 0;
};

// The fields for tests of pairs come first, then those for making rows. Each is read for every pair, and the
// bodies are too many for the cache.
struct alignas(64) SubstepBody {
  RigidBody body;
  double reach = 0;        ///< maximum distance of a point of its shapes from the centre
  double thickness = 0;    ///< smallest half width of a shape
  double margin = 0;       ///< distance to which contacts are searched in this step
  double push = 0;         ///< how far its corners move by the speed gained from the last step's pushes
  double roll = 0;         ///< how far a corner moves by the body's spin in this step
  Bounds box = {};         ///< box around its shapes at the start of the step
  Vec2 drift;              ///< displacement in this step if nothing pushes it
  std::int32_t state = 0;  ///< index of its state in a step; 0: it does not move
  std::uint32_t version = 0;
  std::uint64_t colours = 0, held_colours = 0;  ///< colours used by its contacts in this step
  SubstepKick kick;
  float inverse_mass = 0, inverse_inertia = 0;  ///< body's values as floats, for this step
  float pull = 0;       ///< forces of joints times their levers, times the square of the sub-step's length
  bool is_busy = true;  ///< true if it hardly moves, or was pushed in the last step
  bool exists = false, is_asleep = false, is_frozen = false;
  bool is_changed = false;   ///< immovable, and set or removed since the last step
  bool is_shaken = false;    ///< it may touch a fast body or overlaps deeply in this step
  bool is_diverted = false;  ///< another fast body changed its path in this step
  bool is_stopped = false;   ///< it was stopped or diverted in any step of this tick
  double turn = 0;           ///< rotation in this step, in rad
  double part = 1;           ///< part of its motion done in this step: less than 1 if it was stopped
  double still = 0;          ///< number of ticks for which it has been still
  double first_speed = 0;    ///< speed when it became still
  std::int32_t ring = -1;    ///< next body that fell asleep with it
  std::int32_t proxy = -1;   ///< index in the broad phase
  std::uint64_t order = 0;
  std::int64_t pushed_at = -1;       ///< number of the step in which it was last pushed or slowed
  std::int32_t form = -1;            ///< number of its shapes in SubstepForms
  std::uint32_t turned_version = 0;  ///< `version` of the shapes from which `turned` was computed
  Rotation turned_at;                ///< rotation for which `turned` was computed
  std::vector<Vec2> turned;          ///< corners and normals of its shapes in world axes
  Bounds bounds = {};                ///< bounds of `turned`
};

/// Converts an inverse mass or inertia for rows. The lower limit keeps impulses finite, so that a row does
/// not spoil the state shared by all immovable bodies.
inline float inverseOf(double inverse) {
  return inverse > 0 ? static_cast<float>(std::fmax(inverse, 1e-25)) : 0;
}

inline bool isMovable(const SubstepBody& b) {
  return isMovable(b.body);
}

}  // namespace naiad::physics
