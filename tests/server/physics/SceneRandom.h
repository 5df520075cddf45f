// Simple random numbers, only for the scenes of tests.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace naiad::physics::test {

struct SceneRandom {
  std::uint64_t state = 1;
  double operator()() {  // Returns a number in [0, 1).
    state = state * 6364136223846793005u + 1442695040888963407u;
    return static_cast<double>(state >> 11) * 0x1p-53;
  }
  double between(double low, double high) { return low + (high - low) * (*this)(); }
  int below(int n) { return static_cast<int>((*this)() * n); }
  template <class... Values>
  double oneOf(Values... values) {
    const std::array all = {static_cast<double>(values)...};
    return all.at(static_cast<std::size_t>(below(static_cast<int>(all.size()))));
  }
};

}  // namespace naiad::physics::test
