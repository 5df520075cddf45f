// Rarely read attributes of an Object. The store keeps them by slot, but apart from its arrays.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "Vector.h"

namespace df {

/// Type of Objects without a type of their own, in compat as in the published engine.
inline constexpr const char* kUndefinedType = "(Undefined)";

struct ObjectProfile {
  std::string type = "Object";
  // Values of setSpeed() and setDirection(). After an acceleration or setVelocity(), the store's flag kDerive
  // says that they are derived from the velocity when they are read. If setVelocity() got a vector that the
  // store had to round, they are derived from this vector, which is in `direction` (direction_is_velocity).
  double speed = 0;
  Vector direction;
  bool direction_is_velocity = false;
  std::vector<std::uint32_t> interests;  ///< numbers of event types, see Interests.h
};

}  // namespace df
