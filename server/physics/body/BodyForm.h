// What a body is shaped like, and how it turns: of those whose shape is not their Object's box, or that turn.
#pragma once

#include <cstdint>
#include <vector>

#include "physics/geometry/ConvexShape.h"
#include "physics/geometry/Rotation.h"

namespace naiad::physics {

/// Plain data, beside the body's row.
struct BodyForm {
  std::vector<ConvexShape> shapes;  ///< about the centre of mass, which is the place; none: the Object's box
  double reach = 0;                 ///< of all shapes, from the place
  double unit_inertia = 0;          ///< moment of inertia per mass, of `shapes`
  Rotation rotation;                ///< of the shapes against the axes of the world
  double spin = 0;                  ///< rad per tick
  double torque = 0;                ///< for the next step
  std::uint32_t version = 0;        ///< counts other shapes
  bool is_turning = false;          ///< may impacts and torques turn it?
};

}  // namespace naiad::physics
