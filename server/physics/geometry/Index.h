// Converts int, which counts bodies, nodes and rows, to size_t, which indexes standard containers.
#pragma once

#include <concepts>
#include <cstddef>

namespace naiad::physics {

/// Converts an index; `i` must not be negative.
template <std::integral Number>
constexpr std::size_t at(Number i) {
  return static_cast<std::size_t>(i);
}

}  // namespace naiad::physics
