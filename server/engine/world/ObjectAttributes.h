// The attributes of an Object that serialize() writes, as bits, and what they were when it did.
#pragma once

#include <array>
#include <string>

#include "detail/Dialect.h"

namespace df {

/// One bit each.
enum class ObjectAttribute : unsigned int {
  ID = 1 << 0,
  ACTIVE = 1 << 1,
  VISIBLE = 1 << 2,
  EVENTS = 1 << 3,
  BOX = 1 << 4,
  POSITION = 1 << 5,
  TYPE = 1 << 6,
  ANIMATION = 1 << 7,
  ALTITUDE = 1 << 8,
  SOLIDNESS = 1 << 9,
  NO_SOFT = 1 << 10,
  SPEED = 1 << 11,
  DIRECTION = 1 << 12,
  ACCELERATION = 1 << 13,
  SHAPE = 1 << 14,
  PATH = 1 << 15,
  FOLLOW_PATH = 1 << 16,
  AVOID_COLLISIONS = 1 << 17,
};
/// How many there are; derived classes' own begin with this bit.
inline constexpr int ObjectAttributeMax = 18;

/// Each attribute as text, "name:value," or several of these; by the number of its bit.
using ObjectAttributes = std::array<std::string, ObjectAttributeMax>;

}  // namespace df
