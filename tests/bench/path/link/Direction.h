// One direction of the link: packets enter, and come out later or never.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "../Monotonic.h"
#include "tests/support/net/LossyLine.h"

namespace bench::path {

class Direction {
 public:
  /// Counts the bytes of all packets in `bytes`, including lost ones. If `blocks_udp`, drops UDP.
  Direction(const naiad::LinkConditions& conditions, bool blocks_udp, std::uint64_t seed,
            std::atomic<std::uint64_t>& bytes)
      : m_line(conditions, seed), m_blocks_udp(blocks_udp), m_bytes(bytes) {}

  /// Accepts an IP packet. Packets other than IPv4 are dropped without being counted.
  void take(std::span<const std::uint8_t> packet, Nanoseconds now) {
    constexpr std::size_t kHeader = 20, kProtocol = 9;
    constexpr std::uint8_t kUdp = 17;
    if (packet.size() < kHeader || packet[0] >> 4 != 4) return;
    m_bytes += packet.size();
    if (m_blocks_udp && packet[kProtocol] == kUdp) return;
    const auto fate = m_line.send(std::chrono::floor<naiad::LossyLine::Time>(now), packet.size());
    if (fate.copies > 0) m_flying.push_back({{packet.begin(), packet.end()}, fate.arrivals[0]});
  }
  /// Returns when the next packet comes out; nullopt while none is under way.
  std::optional<Nanoseconds> next() const {
    return m_flying.empty() ? std::nullopt : std::optional(m_flying.front().due);
  }
  /// A packet that came out, and when it was due. `packet` is empty if none was due.
  struct Delivery {
    std::vector<std::uint8_t> packet;
    Nanoseconds due{};
  };
  Delivery pop(Nanoseconds now) {
    if (m_flying.empty() || m_flying.front().due > now) return {};
    Delivery delivery = std::move(m_flying.front());
    m_flying.pop_front();
    return delivery;
  }

 private:
  naiad::LossyLine m_line;
  bool m_blocks_udp;
  std::atomic<std::uint64_t>& m_bytes;
  std::deque<Delivery> m_flying;  // packets under way, ordered by `due`
};

/// Counters of a link, which other processes read while it runs (SharedFile).
struct LinkCounters {
  std::atomic<std::uint64_t> down{0};  ///< bytes of IP packets sent to the client, with headers
  std::atomic<std::uint64_t> up{0};

  static constexpr std::size_t kLateSteps = 1000;
  static constexpr std::int64_t kLateStepNanos = 100'000;
  /// Number of packets by delay beyond their time, in tenths of a millisecond. The last element includes all
  /// longer delays.
  std::array<std::atomic<std::uint64_t>, kLateSteps> late{};
};

}  // namespace bench::path
