// Rarely read attributes of an Object, which the store keeps by slot apart from its arrays.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "Vector.h"

namespace df {

/// Type of Objects without a type of their own, in the published engine.
inline constexpr const char* kUndefinedType = "(Undefined)";

struct ObjectProfile {
  std::string type = "Object";
  // Values of setSpeed() and setDirection(). After an acceleration (a flag in the store) or setVelocity(),
  // which may leave its vector in the direction, they are derived when they are read.
  double speed = 0;
  Vector direction;
  bool direction_is_velocity = false;
  std::vector<std::uint32_t> interests;  ///< numbers of event types, see Interests.h
};

}  // namespace df
