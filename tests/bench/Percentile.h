// Percentiles of measured values.
#pragma once

#include <algorithm>
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

}  // namespace bench
