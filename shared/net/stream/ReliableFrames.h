// Frames that must arrive even if the stream that carries them breaks.
//
// The sender numbers them from 1 and keeps each until the other end acknowledges it; kept frames are sent
// again on the session's next stream. The receiver accepts each number once. Numbers are compared as serial
// numbers (RFC 1982). Gaps are allowed: a server drops frames that a later one replaces, and the oldest chat
// if there is too much (host/session/ReliableOutbox.h).
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <string>

namespace naiad {

/// The sending end of a client. Not thread-safe.
class ReliableFrameSender {
 public:
  /// Limit of the kept frames, in bytes with their headers.
  static constexpr std::size_t kMax = std::size_t{64} * 1024;

  /// The number of the next frame; never 0.
  std::uint32_t next() const { return m_next; }
  /// Keeps this frame under the number next(). Returns false, and keeps nothing, if that exceeds kMax.
  bool add(std::string frame);
  /// Drops the frames up to `number`, which the other end has received. Ignores numbers that were never sent.
  void acknowledge(std::uint32_t number);
  /// Calls `send(frame)` for all kept frames, in order.
  template <class Send>
  void forEach(Send send) const {
    for (const Unacknowledged& kept : m_unacknowledged) send(kept.frame);
  }

  std::size_t bytes() const { return m_bytes; }

 private:
  struct Unacknowledged {
    std::uint32_t number = 0;
    std::string frame;
    std::size_t size() const;
  };

  std::deque<Unacknowledged> m_unacknowledged;  ///< kept frames, by number
  std::size_t m_bytes = 0;
  std::uint32_t m_next = 1;
};

/// The receiving end.
class ReliableFrameReceiver {
 public:
  /// Returns true, and records it, if `number` is newer than newest(). Always true for 0 (a frame not kept).
  bool accept(std::uint32_t number);
  /// The newest received number; 0: none.
  std::uint32_t newest() const { return m_newest; }

 private:
  std::uint32_t m_newest = 0;
};

}  // namespace naiad
