// Spans of time and points in time as admins write and read them.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <string_view>

namespace naiad {

/// The longest accepted span: ten years.
inline constexpr std::chrono::seconds kMaxTimeSpan{std::chrono::hours(24 * 3653)};

/// Parses a duration (shared/options/Duration.h), rounded to seconds. Returns nullopt if it is invalid, less
/// than a second, or above kMaxTimeSpan.
std::optional<std::chrono::seconds> readTimeSpan(std::string_view text);

/// Returns "90s", "30m", "2h" or "7d": the span in the largest unit that divides it. Returns "0s" for less
/// than a second.
std::string timeSpanText(std::chrono::seconds span);

/// Returns, for example, "2026-11-25 19:01 UTC".
std::string timeText(std::chrono::system_clock::time_point time);

}  // namespace naiad
