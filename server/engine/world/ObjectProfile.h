// The rarely read attributes of an Object, beside its place in the arrays of the world. The store keeps it,
// by slot.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "Vector.h"

namespace df {

/// The type of Objects without one, in the published engine.
inline constexpr const char* kUndefinedType = "(Undefined)";

struct ObjectProfile {
  std::string type = "Object";
  // What setSpeed and setDirection said. After an acceleration (a flag in the store) or setVelocity, which
  // leaves the vector it got in the direction, they are derived when they are read.
  double speed = 0;
  Vector direction;
  bool direction_is_velocity = false;
  std::vector<std::uint32_t> interests;  ///< numbers of event types, see Interests.h
};

}  // namespace df
