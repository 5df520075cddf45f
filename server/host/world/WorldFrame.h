// Frames between a host and a world in a process of its own: a length, then fields in order.
//
//   frame   length of the rest (4, low byte first), at most kMaxWorldFrame | fields
//
// A function that visits a struct's fields describes it once, for both ends:
//
//   template <class Fields, class T>          // a FieldWriter and a const T, or a FieldReader and a T
//   void visit(Fields& f, T& facts) { f.flag(facts.shown); f.number(facts.id, 1, 9); … }
//
// A new field is then one line. Texts and lists have a maximum length, which bounds the memory and time that
// a frame costs its reader. Both ends have one build, so there are no versions: the first frame names the
// build (BuildId.h), and a world of another build is ended. But a world runs a game's code: a reader checks
// every number. A writer clamps each number to its range, so that no game is refused because of a coordinate.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "shared/replica/Bytes.h"
#include "shared/values/Fixed.h"
#include "shared/values/LittleEndian.h"

namespace naiad {

/// Maximum bytes of a frame's fields.
inline constexpr std::size_t kMaxWorldFrame = std::size_t{16} << 20;
/// Bytes of a frame's length.
inline constexpr std::size_t kWorldFrameHead = 4;

/// Writes the fields of a frame, which is complete only after finish(). A view of a world has thousands of
/// numbers in each tick, which are written straight into allocated memory.
class FieldWriter {
 public:
  /// Begins a frame in `out`, and reuses its memory.
  explicit FieldWriter(std::string& out) : m_out(out) {
    if (m_out.size() < kFirstSize) m_out.resize(kFirstSize);
    m_p_next = m_out.data() + kWorldFrameHead;
    m_p_end = m_out.data() + m_out.size();
  }
  /// Completes the frame. Returns false if it is too long to be sent.
  bool finish() {
    m_out.resize(size());
    const std::size_t fields = m_out.size() - kWorldFrameHead;
    if (fields > kMaxWorldFrame) return false;
    storeLittleEndian(static_cast<std::uint32_t>(fields), m_out.data());
    return true;
  }

  void flag(bool value) {
    *reserve(1) = value ? 1 : 0;
    ++m_p_next;
  }
  /// Writes an integer or enumeration, clamped to the range from `least` to `most`.
  template <class T>
  void number(T value, std::int64_t least, std::int64_t most) {
    varint(static_cast<std::uint64_t>(std::clamp(static_cast<std::int64_t>(value), least, most) - least));
  }
  void number(std::uint32_t value) { varint(value); }
  /// Writes 64 bits, clamped to ±`most`.
  void fixed(df::Fixed value, df::Fixed most) {
    storeLittleEndian(static_cast<std::uint64_t>(std::clamp(value, -most, most)), reserve(8));
    m_p_next += 8;
  }
  /// Writes a text, truncated to `most` bytes.
  void text(std::string_view value, std::size_t most) {
    value = value.substr(0, most);
    varint(value.size());
    m_p_next = std::copy(value.begin(), value.end(), reserve(value.size()));
  }
  /// Writes the first `most` elements, each by `visit(*this, element)`.
  template <class T, class Visit>
  void list(const std::vector<T>& values, std::size_t most, Visit visit) {
    const std::size_t count = std::min(values.size(), most);
    varint(count);
    for (std::size_t i = 0; i < count; ++i) visit(*this, values[i]);
  }
  static constexpr bool kReads = false;

 private:
  static constexpr std::size_t kFirstSize = 256;
  static constexpr std::size_t kMaxVarint = 10;

  std::size_t size() const { return static_cast<std::size_t>(m_p_next - m_out.data()); }
  /// Makes space for the next `count` bytes, and returns its address.
  char* reserve(std::size_t count) {
    if (static_cast<std::size_t>(m_p_end - m_p_next) < count) grow(count);
    return m_p_next;
  }
  void grow(std::size_t count) {
    // Grows rarely, because a frame is nearly as long as the previous one, whose memory is reused.
    const std::size_t used = size();
    m_out.resize(m_out.size() + m_out.size() / 8 + kFirstSize + count);
    m_p_next = m_out.data() + used;
    m_p_end = m_out.data() + m_out.size();
  }
  void varint(std::uint64_t value) {
    char* p = reserve(kMaxVarint);
    if (value < 0x80) {  // most numbers are so small
      *p = static_cast<char>(value);
      m_p_next = p + 1;
      return;
    }
    for (; value >= 0x80; value >>= 7) *p++ = static_cast<char>(static_cast<std::uint8_t>(value) | 0x80);
    *p++ = static_cast<char>(value);
    m_p_next = p;
  }

  std::string& m_out;
  char* m_p_next = nullptr;
  char* m_p_end = nullptr;
};

/// Reads the fields of a frame. After the first error, all further reads fail.
class FieldReader {
 public:
  /// `fields`: the frame without its length.
  explicit FieldReader(std::string_view fields) : m_bytes(fields) {}
  bool ok() const { return m_bytes.ok(); }
  /// True if all bytes were read, and all fields were valid.
  bool isFullyRead() const { return m_bytes.ok() && m_bytes.atEnd(); }
  void fail() { m_bytes.fail(); }
  /// Fails if `so` is false.
  void require(bool so) {
    if (!so) m_bytes.fail();
  }

  void flag(bool& value) { value = m_bytes.upTo(1) != 0; }
  template <class T>
  void number(T& value, std::int64_t least, std::int64_t most) {
    value = static_cast<T>(static_cast<std::int64_t>(m_bytes.upTo(static_cast<std::uint64_t>(most - least))) +
                           least);
  }
  void number(std::uint32_t& value) { number(value, 0, std::numeric_limits<std::uint32_t>::max()); }
  void fixed(df::Fixed& value, df::Fixed most) {
    const std::string_view bytes = m_bytes.bytes(8);
    value = bytes.empty() ? 0 : static_cast<df::Fixed>(loadLittleEndian<std::uint64_t>(bytes.data()));
    if (value >= -most && value <= most) return;
    value = 0;
    fail();
  }
  void text(std::string& value, std::size_t most) { value = m_bytes.bytes(m_bytes.upTo(most)); }
  /// Reads a list. Fails if it has more than `most` elements, before memory for them is allocated.
  template <class T, class Visit>
  void list(std::vector<T>& values, std::size_t most, Visit visit) {
    values.clear();
    const std::uint64_t count = m_bytes.upTo(most);
    for (std::uint64_t i = 0; i < count && ok(); ++i) visit(*this, values.emplace_back());
  }
  static constexpr bool kReads = true;

 private:
  ByteReader m_bytes;
};

/// Visits a pair of coordinates within ±`most`.
template <class Fields, class T>
void visitVector(Fields& f, T& vector, df::Fixed most) {
  f.fixed(vector.x, most);
  f.fixed(vector.y, most);
}

}  // namespace naiad
