// Percentiles and quantiles of measured values.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace bench {

/// Returns the value below which `percent` of the values are; for 100 the largest; 0 if there are no values.
template <class Value>
Value percentile(std::vector<Value> values, std::size_t percent) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return values[std::min(values.size() - 1, values.size() * percent / 100)];
}

/// Returns the smallest sample not less than `share` (0 to 1) of all samples; NaN without samples.
inline double quantile(std::vector<double> samples, double share) {
  if (samples.empty()) return NAN;
  const double rank = std::ceil(share * static_cast<double>(samples.size())) - 1;
  const auto index = static_cast<std::ptrdiff_t>(std::max(rank, 0.0));
  std::nth_element(samples.begin(), samples.begin() + index, samples.end());
  return samples[static_cast<std::size_t>(index)];
}

}  // namespace bench
