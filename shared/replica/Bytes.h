// Writes and reads small integers as bytes: LEB128 varints and zig-zag, like protobuf.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace naiad {

class ByteWriter {
 public:
  explicit ByteWriter(std::string& out) : m_out(out) {}

  void byte(std::uint8_t value) { m_out.push_back(static_cast<char>(value)); }
  void varint(std::uint64_t value) {
    for (; value >= 0x80; value >>= 7) byte(static_cast<std::uint8_t>(value) | 0x80);
    byte(static_cast<std::uint8_t>(value));
  }
  void zigzag(std::int64_t value) {
    varint((static_cast<std::uint64_t>(value) << 1) ^ static_cast<std::uint64_t>(value >> 63));
  }
  void bytes(std::string_view value) { m_out.append(value); }

 private:
  std::string& m_out;
};

/// Reads the bytes of a ByteWriter. After a number that is missing, longer than 64 bits or out of range, ok()
/// is false, and all reads return 0 or no bytes.
class ByteReader {
 public:
  explicit ByteReader(std::string_view bytes) : m_bytes(bytes) {}

  bool ok() const { return m_ok; }
  bool atEnd() const { return m_at == m_bytes.size(); }
  void fail() { m_ok = false; }

  std::uint8_t byte() {
    if (!m_ok || m_at >= m_bytes.size()) {
      m_ok = false;
      return 0;
    }
    return static_cast<std::uint8_t>(m_bytes[m_at++]);
  }

  std::uint64_t varint() {
    // A shortcut, because most numbers are small.
    if (m_ok && m_at < m_bytes.size() && static_cast<std::uint8_t>(m_bytes[m_at]) < 0x80)
      return static_cast<std::uint8_t>(m_bytes[m_at++]);
    std::uint64_t value = 0;
    for (int shift = 0; shift < 64; shift += 7) {
      const std::uint8_t b = byte();
      if (shift == 63 && b > 1) break;
      value |= static_cast<std::uint64_t>(b & 0x7F) << shift;
      if ((b & 0x80) == 0) return m_ok ? value : 0;
    }
    m_ok = false;
    return 0;
  }

  /// Reads a varint of at most `most`.
  std::uint64_t upTo(std::uint64_t most) {
    const std::uint64_t value = varint();
    if (value > most) m_ok = false;
    return m_ok ? value : 0;
  }

  std::int64_t zigzag() {
    const std::uint64_t value = varint();
    return static_cast<std::int64_t>(value >> 1) ^ -static_cast<std::int64_t>(value & 1);
  }

  /// Reads a zig-zag number within ±`most`.
  std::int64_t within(std::int64_t most) {
    const std::int64_t value = zigzag();
    if (value < -most || value > most) m_ok = false;
    return m_ok ? value : 0;
  }

  /// Returns all unread bytes.
  std::string_view rest() { return bytes(m_bytes.size() - m_at); }
  std::string_view bytes(std::size_t count) {
    if (!m_ok || count > m_bytes.size() - m_at) {
      m_ok = false;
      return {};
    }
    const std::string_view part = m_bytes.substr(m_at, count);
    m_at += count;
    return part;
  }

 private:
  std::string_view m_bytes;
  std::size_t m_at = 0;
  bool m_ok = true;
};

}  // namespace naiad
