// Bodies, nodes and rows are counted by int, and containers of the standard library are indexed by size_t.
#pragma once

#include <cstddef>

namespace naiad::physics {

/// `i` is not negative.
constexpr std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

}  // namespace naiad::physics
