// Writes and reads numbers of any width as a string of bits, for records that must be small.
//
// Bits fill each byte from its low end; a number is written low bit first. There are two further codes:
//
//   exp-Golomb of order k   v + 2^k in binary takes n bits: n − 1 − k zeros, a one, n − 1 lower bits.
//                           Small numbers are short, all numbers are possible (ITU-T H.264, 9.1).
//   zig-zag                 0, −1, 1, −2 as 0, 1, 2, 3
#pragma once

#include <bit>
#include <cassert>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "shared/values/LittleEndian.h"

namespace naiad {

/// clear() keeps the memory, so a reused writer allocates only when it needs more than before.
class BitWriter {
 public:
  /// Appends the `count` low bits of `value`; the others must be zero. count: 0 … 64.
  void bits(std::uint64_t value, int count) {
    assert(count >= 0 && count <= 64 && (count == 64 || value >> count == 0));
    m_pending |= value << m_pending_count;
    m_pending_count += count;
    if (m_pending_count < 64) return;
    m_words.push_back(m_pending);
    m_pending_count -= 64;
    // The rest: the upper bits of the value, if any. (A shift by 64 is undefined.)
    m_pending = m_pending_count == 0 ? 0 : value >> (count - m_pending_count);
  }
  void flag(bool value) { bits(value ? 1 : 0, 1); }
  /// Appends the `count` low bits of a two's complement number, which must fit.
  void signedBits(std::int64_t value, int count) {
    assert(count == 0 ? value == 0 : value >> (count - 1) == 0 || value >> (count - 1) == -1);
    bits(count == 64 ? static_cast<std::uint64_t>(value)
                     : static_cast<std::uint64_t>(value) & ((std::uint64_t{1} << count) - 1),
         count);
  }
  /// Appends an exp-Golomb code; value + 2^order must be below 2^64.
  void golomb(std::uint64_t value, int order) {
    const std::uint64_t shifted = value + (std::uint64_t{1} << order);
    const int length = std::bit_width(shifted);
    const int zeros = length - 1 - order;
    bits(0, zeros);
    bits(1, 1);
    bits(shifted & ~(std::uint64_t{1} << (length - 1)), length - 1);
  }
  void signedGolomb(std::int64_t value, int order) {
    golomb((static_cast<std::uint64_t>(value) << 1) ^ static_cast<std::uint64_t>(value >> 63), order);
  }
  void append(const BitWriter& other) { append(other, 0, other.bitCount()); }
  /// Appends `count` bits of another writer, beginning with bit `from`.
  void append(const BitWriter& other, std::size_t from, std::size_t count) {
    for (; count > 64; from += 64, count -= 64) bits(other.word(from), 64);
    if (count == 64) return bits(other.word(from), 64);
    bits(other.word(from) & ((std::uint64_t{1} << count) - 1), static_cast<int>(count));
  }

  /// Removes all but the first `count` bits.
  void truncate(std::size_t count) {
    assert(count <= bitCount());
    m_pending_count = static_cast<int>(count % 64);
    m_pending = wordAt(count / 64) & ((std::uint64_t{1} << m_pending_count) - 1);
    m_words.resize(count / 64);
  }

  /// Returns all bits as a number, the first one lowest; there must be fewer than 64.
  std::uint64_t value() const {
    assert(m_words.empty());
    return m_pending;
  }
  std::size_t bitCount() const { return m_words.size() * 64 + static_cast<std::size_t>(m_pending_count); }
  std::size_t byteCount() const { return (bitCount() + 7) / 8; }
  void clear() {
    m_words.clear();
    m_pending = 0;
    m_pending_count = 0;
  }
  /// Like bytes() below, into a string whose memory is reused.
  void bytes(std::string& all) const {
    all.resize(m_words.size() * 8 + static_cast<std::size_t>(m_pending_count + 7) / 8);
    char* at = all.data();
    for (const std::uint64_t word : m_words) {
      storeLittleEndian(word, at);
      at += 8;
    }
    for (std::uint64_t rest = m_pending; at != all.data() + all.size(); rest >>= 8) {
      *at++ = static_cast<char>(rest & 0xFF);
    }
  }
  /// Returns all bits; the last byte is padded with zeros.
  std::string bytes() const {
    std::string all;
    bytes(all);
    return all;
  }

 private:
  /// Returns the 64 bits from `from` on, padded with zeros.
  std::uint64_t word(std::size_t from) const {
    const std::size_t index = from / 64;
    const int shift = static_cast<int>(from % 64);
    const std::uint64_t low = wordAt(index) >> shift;
    return shift == 0 ? low : low | wordAt(index + 1) << (64 - shift);
  }
  std::uint64_t wordAt(std::size_t index) const {
    if (index < m_words.size()) return m_words[index];
    return index == m_words.size() ? m_pending : 0;
  }

  std::vector<std::uint64_t> m_words;  ///< full words
  std::uint64_t m_pending = 0;
  int m_pending_count = 0;  ///< below 64 between calls
};

/// Reads the bits of a BitWriter. After a missing or out-of-range number, ok() is false and reads return 0.
class BitReader {
 public:
  explicit BitReader(std::string_view bytes) : m_bytes(bytes) {}

  bool ok() const { return m_ok; }
  void fail() { m_ok = false; }
  std::size_t remainingBits() const { return m_bytes.size() * 8 - m_at; }
  /// True if ok() and only the last byte's padding, which must be zeros, is left. Reads the padding.
  bool atEnd() {
    const int left = static_cast<int>(remainingBits());
    return m_ok && remainingBits() < 8 && bits(left) == 0;
  }

  std::uint64_t bits(int count) {
    if (!m_ok || static_cast<std::size_t>(count) > remainingBits()) {
      m_ok = false;
      return 0;
    }
    const std::uint64_t value = next();
    m_at += static_cast<std::size_t>(count);
    return count == 64 ? value : value & ((std::uint64_t{1} << count) - 1);
  }
  bool flag() { return bits(1) != 0; }
  std::int64_t signedBits(int count) {
    const std::uint64_t value = bits(count);
    if (count == 0 || count == 64) return static_cast<std::int64_t>(value);
    const std::uint64_t sign = std::uint64_t{1} << (count - 1);
    return static_cast<std::int64_t>((value ^ sign) - sign);
  }
  /// Reads an exp-Golomb code of at most `most`.
  std::uint64_t golomb(int order, std::uint64_t most) {
    const int zeros = std::countr_zero(next());
    const int length = order + zeros;
    if (length > 63) m_ok = false;
    bits(zeros + 1);
    const std::uint64_t shifted = bits(m_ok ? length : 0) | (std::uint64_t{1} << length % 64);
    const std::uint64_t value = shifted - (std::uint64_t{1} << order);
    if (value > most) m_ok = false;
    return m_ok ? value : 0;
  }
  /// Reads a zig-zag exp-Golomb code within ±`most`.
  std::int64_t signedGolomb(int order, std::int64_t most) {
    const std::uint64_t code = golomb(order, UINT64_MAX);
    const std::int64_t value = static_cast<std::int64_t>(code >> 1) ^ -static_cast<std::int64_t>(code & 1);
    if (value < -most || value > most) m_ok = false;
    return m_ok ? value : 0;
  }

 private:
  /// Returns the next 64 bits, padded with zeros.
  std::uint64_t next() const {
    const std::size_t at = m_at >> 3;
    const int offset = static_cast<int>(m_at & 7);
    const std::uint64_t low = word(at) >> offset;
    return offset == 0 ? low : low | word(at + 8) << (64 - offset);
  }
  /// Returns eight bytes, padded with zeros.
  std::uint64_t word(std::size_t at) const {
    const std::size_t size = m_bytes.size();
    if (at + 8 <= size) return loadLittleEndian<std::uint64_t>(m_bytes.data() + at);
    if (at >= size) return 0;
    if (size >= 8) return loadLittleEndian<std::uint64_t>(m_bytes.data() + size - 8) >> 8 * (at + 8 - size);
    std::uint64_t word = 0;
    for (std::size_t i = at; i < m_bytes.size(); ++i) {
      word |= std::uint64_t{static_cast<unsigned char>(m_bytes[i])} << (8 * (i - at));
    }
    return word;
  }

  std::string_view m_bytes;
  std::size_t m_at = 0;  ///< index of the next bit
  bool m_ok = true;
};

}  // namespace naiad
