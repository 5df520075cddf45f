// Spans of time as people write them: 90s, 30m, 2h, 7d.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <string_view>

namespace naiad {

/// The longest accepted span: ten years.
inline constexpr std::chrono::seconds kMaxTimeSpan{std::chrono::hours(24 * 3653)};

/// Parses a whole number >= 1 and a unit: s, m, h, d or w. Returns nullopt if invalid or above kMaxTimeSpan.
std::optional<std::chrono::seconds> readTimeSpan(std::string_view text);

/// Returns "90s", "30m", "2h" or "7d": the span in the largest unit that divides it. Returns "0s" for less
/// than a second.
std::string timeSpanText(std::chrono::seconds span);

/// Returns, for example, "2026-11-25 19:01 UTC".
std::string timeText(std::chrono::system_clock::time_point time);

}  // namespace naiad
