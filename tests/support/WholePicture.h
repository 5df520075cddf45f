// Does a client show all that the server has sent it? Only then is its picture to be compared with the
// world's.
//
// A snapshot that is complete says that the server has nothing more to send. One before it may be lost, or
// come later: by datagram what is sent after it on the stream overtakes it.
#pragma once

#include <cstdint>

#include "shared/replica/Acks.h"
#include "shared/replica/SnapshotCodec.h"

namespace naiad::test {

class WholePicture {
 public:
  /// `before`: number of the newest snapshot that was sent before those to come.
  explicit WholePicture(std::uint32_t before = 0) : m_before(before) {}

  /// A snapshot was applied; `acks`: what has arrived by now, that one included.
  void addSnapshot(const SnapshotHeader& header, const AckWindow& acks) {
    if (header.number == acks.newest) {
      m_complete = header.complete;
      m_tick = header.tick;
    }
    m_whole = m_complete && hasAll(acks);
  }
  bool isWhole() const { return m_whole; }
  /// Of the newest snapshot, by number. Late ones do not change it.
  std::uint32_t tick() const { return m_tick; }

 private:
  /// Those that the window has left count as arrived: the sender took them for lost, and sent what they said
  /// again, before it called a snapshot complete.
  bool hasAll(const AckWindow& acks) const {
    const auto between = static_cast<std::int32_t>(acks.newest - m_before) - 1;
    if (between <= 0) return between == 0;
    const std::uint64_t all = between >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << between) - 1;
    return (acks.mask & all) == all;
  }

  std::uint32_t m_before;
  std::uint32_t m_tick = 0;
  bool m_complete = false;  ///< the newest snapshot
  bool m_whole = false;
};

}  // namespace naiad::test
