// Hashes the exact bits of numbers, to compare the results of different compilers.
#pragma once

#include <bit>
#include <cstdint>
#include <initializer_list>

#include "physics/geometry/Vec2.h"

namespace naiad::physics::test {

class BitHash {
 public:
  void add(std::uint64_t value) { m_hash = (m_hash ^ value) * 0x100000001b3 ^ m_hash >> 32; }
  void add(double value) { add(std::bit_cast<std::uint64_t>(value)); }
  void add(std::initializer_list<double> values) {
    for (const double value : values) add(value);
  }
  void add(Vec2 v) { add({v.x, v.y}); }
  std::uint64_t value() const { return m_hash; }

 private:
  std::uint64_t m_hash = 0xcbf29ce484222325;
};

}  // namespace naiad::physics::test
