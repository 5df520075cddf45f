// Attributes of an Object that serialize() writes, as bits and as text.
#pragma once

#include <array>
#include <string>

#include "detail/LanguageStandard.h"

namespace df {

// In the published engine, enumerations were unscoped until 4.18 and are scoped since. With Naiad, games may
// write df::POSITION or df::ObjectAttribute::POSITION. -DDF_SCOPED_ENUMS allows only the second form, for
// games that use the first as names of their own.
#if !defined(DF_ENUM)
#if defined(DF_SCOPED_ENUMS)
#define DF_ENUM enum class
#else
#define DF_ENUM enum
#endif
#endif

/// The attributes, one bit each.
DF_ENUM ObjectAttribute : unsigned int{
                              ID = 1 << 0,         ACTIVE = 1 << 1,        VISIBLE = 1 << 2,
                              EVENTS = 1 << 3,     BOX = 1 << 4,           POSITION = 1 << 5,
                              TYPE = 1 << 6,       ANIMATION = 1 << 7,     ALTITUDE = 1 << 8,
                              SOLIDNESS = 1 << 9,  NO_SOFT = 1 << 10,      SPEED = 1 << 11,
                              DIRECTION = 1 << 12, ACCELERATION = 1 << 13, SHAPE = 1 << 14,
                              PATH = 1 << 15,      FOLLOW_PATH = 1 << 16,  AVOID_COLLISIONS = 1 << 17,
                              SPRITE = ANIMATION,  ///< older name of ANIMATION
                          };
/// Number of attributes; the attributes of derived classes begin with this bit.
inline constexpr int ObjectAttributeMax = 18;

/// The text of each attribute, indexed by the number of its bit: "name:value,", or several of these.
using ObjectAttributes = std::array<std::string, ObjectAttributeMax>;

}  // namespace df
