// The attributes of an Object that serialize() writes, as bits, and what they were when it did.
#pragma once

#include <array>
#include <string>

#include "detail/Dialect.h"

namespace df {

// The published engine's enumerations were plain until 4.18 and have a scope since. Games may write
// df::POSITION or df::ObjectAttribute::POSITION here; -DDF_SCOPED_ENUMS leaves the second alone, for a game
// with names of its own like these.
#if !defined(DF_ENUM)
#if defined(DF_SCOPED_ENUMS)
#define DF_ENUM enum class
#else
#define DF_ENUM enum
#endif
#endif

/// One bit each.
DF_ENUM ObjectAttribute : unsigned int{
                              ID = 1 << 0,         ACTIVE = 1 << 1,        VISIBLE = 1 << 2,
                              EVENTS = 1 << 3,     BOX = 1 << 4,           POSITION = 1 << 5,
                              TYPE = 1 << 6,       ANIMATION = 1 << 7,     ALTITUDE = 1 << 8,
                              SOLIDNESS = 1 << 9,  NO_SOFT = 1 << 10,      SPEED = 1 << 11,
                              DIRECTION = 1 << 12, ACCELERATION = 1 << 13, SHAPE = 1 << 14,
                              PATH = 1 << 15,      FOLLOW_PATH = 1 << 16,  AVOID_COLLISIONS = 1 << 17,
                              SPRITE = ANIMATION,  ///< the older name
                          };
/// How many there are; derived classes' own begin with this bit.
inline constexpr int ObjectAttributeMax = 18;

/// Each attribute as text, "name:value," or several of these; by the number of its bit.
using ObjectAttributes = std::array<std::string, ObjectAttributeMax>;

}  // namespace df
