// The shape and rotation of a body that turns, or whose shape differs from its Object's box.
#pragma once

#include <cstdint>
#include <vector>

#include "physics/geometry/ConvexShape.h"
#include "physics/geometry/Rotation.h"

namespace naiad::physics {

/// Data of a body in addition to its BodyRow.
struct BodyGeometry {
  std::vector<ConvexShape>
      shapes;                 ///< relative to the centre of mass, which is the place; none: the Object's box
  double reach = 0;           ///< maximum distance of a shape's point from the place
  double unit_inertia = 0;    ///< moment of inertia of `shapes` per mass
  Rotation rotation;          ///< rotation of the shapes relative to the world's axes
  double spin = 0;            ///< rad per tick
  double torque = 0;          ///< applied in the next step, in force · cell widths
  std::uint32_t version = 0;  ///< counts changes of the shapes
  bool is_turning = false;    ///< true if impacts and torques may turn it
};

}  // namespace naiad::physics
