// A histogram of durations: quantiles without storing every sample.
#pragma once

#include <array>
#include <atomic>
#include <bit>
#include <chrono>
#include <cstdint>

namespace naiad {

/// Counts durations up to 9 hours, in steps of 1 µs or of at most 1/16 of the duration. Thread-safe; a reader
/// may miss samples that are just being added.
class TickTimes {
 public:
  void add(std::chrono::nanoseconds duration) {
    m_counts[indexOf(duration.count() / 1000)].fetch_add(1, std::memory_order_relaxed);
  }
  /// Returns the shortest duration that at least this share of the samples does not exceed, rounded up to its
  /// step; 0 if there are no samples.
  std::chrono::microseconds quantile(double share) const {
    const std::uint64_t all = count();
    std::uint64_t longer = all;
    for (std::size_t i = 0; i < kSteps; ++i) {
      longer -= m_counts[i];
      if (static_cast<double>(longer) <= static_cast<double>(all) * (1 - share)) {
        return std::chrono::microseconds(all == 0 ? 0 : upperEnd(i));
      }
    }
    return {};
  }
  std::uint64_t count() const {
    std::uint64_t all = 0;
    for (const auto& n : m_counts) all += n;
    return all;
  }
  /// Removes all samples.
  void reset() {
    for (auto& n : m_counts) n = 0;
  }

 private:
  static constexpr std::size_t kFine = 16;
  static constexpr std::size_t kSteps = 32 * kFine;

  static std::size_t indexOf(std::int64_t micros) {
    if (micros < static_cast<std::int64_t>(kFine)) return micros < 0 ? 0 : static_cast<std::size_t>(micros);
    const auto value = static_cast<std::uint64_t>(micros);
    const auto shift = static_cast<std::size_t>(std::bit_width(value)) - 5;
    const std::size_t index = shift * kFine + (value >> shift);
    return index < kSteps ? index : kSteps - 1;
  }
  static std::int64_t upperEnd(std::size_t index) {
    if (index < kFine) return static_cast<std::int64_t>(index) + 1;
    const std::size_t shift = index / kFine - 1;
    return static_cast<std::int64_t>((index % kFine + kFine + 1) << shift);
  }

  std::array<std::atomic<std::uint64_t>, kSteps> m_counts{};
};

}  // namespace naiad
