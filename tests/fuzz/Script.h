// Reads the fuzzer's bytes from the front as numbers and pieces, by which a target chooses its steps.
#pragma once

#include <algorithm>
#include <concepts>
#include <cstdint>
#include <string>
#include <string_view>

#include "shared/values/SplitMix64.h"

namespace naiad::fuzz {

class Script {
 public:
  Script(const std::uint8_t* data, std::size_t size) : m_left(reinterpret_cast<const char*>(data), size) {}

  bool atEnd() const { return m_left.empty(); }
  /// Returns the next number, little-endian; missing bytes count as 0.
  template <std::unsigned_integral Number>
  Number number() {
    Number value = 0;
    for (std::size_t i = 0; i < sizeof value && !m_left.empty(); ++i, m_left.remove_prefix(1))
      value = static_cast<Number>(value | Number{static_cast<unsigned char>(m_left[0])} << (8 * i));
    return value;
  }
  std::uint8_t byte() { return number<std::uint8_t>(); }
  /// Returns a number in 0 … n − 1.
  std::size_t below(std::size_t n) { return byte() % n; }
  bool flag() { return (byte() & 1) != 0; }
  /// Returns the next `count` bytes, or all if fewer are left.
  std::string bytes(std::size_t count) {
    const std::string piece(m_left.substr(0, count));
    m_left.remove_prefix(piece.size());
    return piece;
  }
  std::string rest() { return bytes(m_left.size()); }

 private:
  std::string_view m_left;
};

/// A copy of the bytes in an allocation of exactly their size, so that the sanitizer detects reads beyond it.
/// (A std::string keeps short texts in itself and has a zero at the end.)
class Exactly {
 public:
  explicit Exactly(std::string_view bytes) : m_size(bytes.size()), m_bytes(new char[m_size]) {
    std::copy(bytes.begin(), bytes.end(), m_bytes);
  }
  Exactly(const Exactly&) = delete;
  Exactly& operator=(const Exactly&) = delete;
  ~Exactly() { delete[] m_bytes; }
  std::string_view view() const { return {m_bytes, m_size}; }

 private:
  std::size_t m_size;
  char* m_bytes;
};

/// Passes the stream to `take` in pieces: one piece if `how` is 0, single bytes if it is 1, else pieces of
/// random sizes below `how`.
template <class Take>
void forEachPiece(std::string_view stream, std::uint8_t how, Take take) {
  SplitMix64 random(how);
  while (!stream.empty()) {
    const std::size_t size = how == 0 ? stream.size() : how == 1 ? 1 : random.below(how);
    const Exactly piece(stream.substr(0, size));
    stream.remove_prefix(piece.view().size());
    take(piece.view());
  }
}

}  // namespace naiad::fuzz

/// The function that libFuzzer calls.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
