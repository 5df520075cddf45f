// A fast 64-bit hash to find differences between replayed worlds and between their answers.
//
// Each step multiplies two words to 128 bits and folds the halves, as wyhash does (Wang Yi, 2019). The result
// is equal on every machine. Not cryptographic: collisions can be constructed.
#pragma once

#include <cstdint>
#include <string_view>

#include "shared/values/LittleEndian.h"

namespace naiad {

class FastHash {
 public:
  void word(std::uint64_t value) { m_state = fold(m_state ^ value, kFirst); }
  void bytes(std::string_view data) {
    std::uint64_t other = kSecond;
    word(data.size());
    for (; data.size() >= 32; data.remove_prefix(32)) {  // two chains, which the processor runs in parallel
      m_state = fold(at(data, 0) ^ kFirst, at(data, 8) ^ m_state);
      other = fold(at(data, 16) ^ kSecond, at(data, 24) ^ other);
    }
    for (; data.size() >= 8; data.remove_prefix(8)) word(at(data, 0));
    std::uint64_t last = 0;
    for (const char byte : data) last = last << 8 | static_cast<unsigned char>(byte);
    word(last);
    word(other);
  }
  std::uint64_t value() const { return fold(m_state, kSecond); }

 private:
  static constexpr std::uint64_t kFirst = 0xa0761d6478bd642fu;
  static constexpr std::uint64_t kSecond = 0xe7037ed1a0b428dbu;

  static std::uint64_t at(std::string_view data, std::size_t offset) {
    return loadLittleEndian<std::uint64_t>(data.data() + offset);
  }
  static std::uint64_t fold(std::uint64_t a, std::uint64_t b) {
    __extension__ using Wide = unsigned __int128;
    const Wide product = static_cast<Wide>(a) * b;
    return static_cast<std::uint64_t>(product) ^ static_cast<std::uint64_t>(product >> 64);
  }

  std::uint64_t m_state = 0x8ebc6af09c88c6e3u;
};

}  // namespace naiad
