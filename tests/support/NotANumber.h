// Values that are not finite, for tests that such values are rejected.
#pragma once

#include <limits>

inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
