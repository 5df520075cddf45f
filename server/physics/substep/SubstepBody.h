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

struct SubstepBody {
  RigidBody body;
  std::vector<ConvexShape> shapes;
  std::vector<TurnedShape> turned;
  Bounds bounds = {};                             ///< of `turned`
  Rotation turned_at;                             ///< what `turned` was made for …
  std::uint32_t turned_version = 0, version = 0;  ///< … and of which shapes
  std::uint64_t order = 0;
  std::int32_t proxy = -1;                      ///< in the broad phase
  std::int32_t state = 0;                       ///< within a step; 0: nothing moves it
  double reach = 0;                             ///< of all shapes, from the centre
  double thickness = 0;                         ///< the least half width of a shape
  double margin = 0;                            ///< how far around it contacts are searched for in this step
  double turn = 0;                              ///< rad, in this step
  double part = 1;                              ///< of its motion in this step: less than 1 if it is stopped
  float kick_x = 0, kick_y = 0, spin_kick = 0;  ///< what a sub-step of acceleration adds
  float inverse_mass = 0, inverse_inertia = 0;  ///< in this step
  float pull = 0;                               ///< of joints, times the sub-step squared
  double still = 0;                             ///< ticks
  double first_speed = 0;                       ///< when it began to be still
  std::int32_t ring = -1;                       ///< the next body that fell asleep with it
  std::uint64_t colours = 0, held_colours = 0;  ///< of its contacts in this step
  bool is_fast = false;                         ///< it goes farther than contacts were searched for
  bool exists = false, is_asleep = false, is_frozen = false;
  bool is_changed = false;  ///< it cannot be moved, and was set or removed since the last step
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
