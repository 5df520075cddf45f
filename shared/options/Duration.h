// Durations as people write them: 90s, 30m, 1.5h, 7d, or a number without a unit.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace naiad {

/// Units of numbers without a unit, in microseconds.
inline constexpr std::int64_t kMicrosecond = 1;
inline constexpr std::int64_t kMillisecond = 1000;
inline constexpr std::int64_t kSecond = 1'000'000;

/// Parses a number, which may have a minus sign, a fraction and an exponent, and a unit: us, ms, s, m, h, d
/// or w. `unit` is that of a number without one. Returns the duration in `unit`; nullopt if the text is
/// invalid.
std::optional<double> readDuration(std::string_view text, std::int64_t unit = kSecond);

/// The longest time span: ten years.
inline constexpr std::chrono::seconds kMaxTimeSpan{std::chrono::hours(24 * 3653)};
/// Returns the duration, rounded to seconds; nullopt if it is invalid, below a second or above kMaxTimeSpan.
std::optional<std::chrono::seconds> readTimeSpan(std::string_view text);

/// Returns "90s", "30m", "2h" or "7d": the span in the largest unit that divides it. Returns "0s" for less
/// than a second.
std::string timeSpanText(std::chrono::seconds span);
/// Returns, for example, "2026-11-25 19:01 UTC".
std::string timeText(std::chrono::system_clock::time_point time);

}  // namespace naiad
