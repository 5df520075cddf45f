// Counts of values by fixed upper bounds, as Prometheus' histograms have them.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace naiad {

/// Not thread-safe. A value costs a search among at most kMaxBounds bounds and one increment.
class Histogram {
 public:
  static constexpr std::size_t kMaxBounds = 16;

  /// `bounds`: the highest value of each bucket, rising, at most kMaxBounds; they outlive the histogram.
  explicit Histogram(std::span<const double> bounds)
      : m_bounds(bounds.first(std::min(bounds.size(), kMaxBounds))) {}

  /// A value that is over all bounds is counted beyond the last.
  void add(double value) {
    const auto found = std::lower_bound(m_bounds.begin(), m_bounds.end(), value);
    ++m_counts[static_cast<std::size_t>(found - m_bounds.begin())];
    m_sum += value;
  }

  std::span<const double> bounds() const { return m_bounds; }
  /// Values in the bucket of this bound alone; `bucket` == bounds().size(): beyond the last.
  std::uint64_t count(std::size_t bucket) const { return m_counts[bucket]; }
  double sum() const { return m_sum; }

 private:
  std::span<const double> m_bounds;
  std::array<std::uint64_t, kMaxBounds + 1> m_counts{};
  double m_sum = 0;
};

}  // namespace naiad
