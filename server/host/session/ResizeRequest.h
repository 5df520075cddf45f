// The terminal size that a client asked for last, applied at most four times a second: each new size may cost
// half a world.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <utility>

namespace naiad {

class ResizeRequest {
 public:
  using Time = std::chrono::steady_clock::time_point;
  struct Size {
    std::uint32_t columns = 0;
    std::uint32_t rows = 0;
  };

  static constexpr std::chrono::milliseconds kEvery{250};

  /// True if this replaces a size that was not applied.
  bool request(Size size) { return std::exchange(m_wanted, size).has_value(); }
  /// Go on with what was requested from `other`.
  void continueFrom(const ResizeRequest& other) { m_wanted = other.m_wanted; }
  /// The size to apply now, if any.
  std::optional<Size> takeDue(Time now) {
    if (!m_wanted || (m_applied && now - *m_applied < kEvery)) return std::nullopt;
    m_applied = now;
    return std::exchange(m_wanted, std::nullopt);
  }

 private:
  std::optional<Size> m_wanted;
  std::optional<Time> m_applied;  ///< when a size was applied last
};

}  // namespace naiad
