// Frames that must arrive although the stream that carries them may break.
//
// The sender numbers them, from 1, and keeps each until the other end says that it came; what is left is sent
// again on the session's next stream. The receiver takes each number once. Numbers are compared as serial
// numbers (RFC 1982) and may have gaps: a server leaves out what a later frame replaces, and the oldest chat
// where there is too much (host/session/ReliableOutbox.h).
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <string>

namespace naiad {

/// A client's end as a sender. Not thread-safe.
class ReliableFrames {
 public:
  /// Kept at most, in bytes with their headers.
  static constexpr std::size_t kMax = std::size_t{64} * 1024;

  /// The number of the next frame; never 0.
  std::uint32_t next() const { return m_next; }
  /// Keep this frame, which has the number next(). False, and nothing is kept, if that is more than kMax.
  bool keep(std::string frame);
  /// The other end has all up to `number`. What was never sent is no acknowledgement.
  void acknowledge(std::uint32_t number);
  /// Call `send(frame)` for all that is kept, in order.
  template <class Send>
  void forEach(Send send) const {
    for (const Kept& kept : m_kept) send(kept.frame);
  }

  std::size_t bytes() const { return m_bytes; }

 private:
  struct Kept {
    std::uint32_t number = 0;
    std::string frame;
    std::size_t size() const;
  };

  std::deque<Kept> m_kept;  ///< in order
  std::size_t m_bytes = 0;
  std::uint32_t m_next = 1;
};

/// The receiver's end.
class ReliableFramesHeard {
 public:
  /// Is this frame news? `number` 0: it is not kept, so it is. Each other number is so once.
  bool take(std::uint32_t number);
  /// Number of the newest that came; 0: none.
  std::uint32_t newest() const { return m_newest; }

 private:
  std::uint32_t m_newest = 0;
};

}  // namespace naiad
