// Durations as people write them: 90s, 30m, 1.5h, 7d, or a number without a unit.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace naiad {

/// Units of numbers without a unit, in microseconds.
inline constexpr std::int64_t kMicrosecond = 1;
inline constexpr std::int64_t kMillisecond = 1000;
inline constexpr std::int64_t kSecond = 1'000'000;

/// Parses a number, which may have a sign and a fraction, and a unit: us, ms, s, m, h, d or w. `unit` is that
/// of a number without one. Returns the duration in `unit`; nullopt if the text is invalid.
std::optional<double> readDuration(std::string_view text, std::int64_t unit = kSecond);

/// True if the text is a duration with a unit. Required where free text can stand instead of a duration.
bool isDurationWithUnit(std::string_view text);

}  // namespace naiad
