// Spans of time as people write them: 90s, 30m, 2h, 7d.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <string_view>

namespace naiad {

/// The longest span that is read: ten years.
inline constexpr std::chrono::seconds kMaxTimeSpan{std::chrono::hours(24 * 3653)};

/// A whole number from 1 on and a unit: s, m, h, d or w. Nothing for other texts, and beyond kMaxTimeSpan.
std::optional<std::chrono::seconds> readTimeSpan(std::string_view text);

/// "90s", "30m", "2h", "7d": in the largest unit in which it is whole. Spans below a second are "0s".
std::string timeSpanText(std::chrono::seconds span);

/// "2026-11-25 19:01 UTC".
std::string timeText(std::chrono::system_clock::time_point time);

}  // namespace naiad
