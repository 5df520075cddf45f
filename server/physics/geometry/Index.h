// Bodies, nodes and rows are counted by int, and containers of the standard library are indexed by size_t.
#pragma once

#include <concepts>
#include <cstddef>

namespace naiad::physics {

/// `i` is not negative.
template <std::integral Number>
constexpr std::size_t at(Number i) {
  return static_cast<std::size_t>(i);
}

}  // namespace naiad::physics
