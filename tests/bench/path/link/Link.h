// Carries packets between two networks, with delay, loss and a rate.
#pragma once

#include <poll.h>
#include <unistd.h>

#include <algorithm>
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

/// One direction of the link: packets enter, and come out later or never.
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

class Link {
 public:
  /// `server_tun` and `client_tun` must be non-blocking; `counters` must outlive the link.
  Link(int server_tun, int client_tun, const naiad::LinkConditions& conditions, bool blocks_udp,
       std::uint64_t seed, LinkCounters& counters)
      : m_server_tun(server_tun),
        m_client_tun(client_tun),
        m_down(conditions, blocks_udp, 2 * seed, counters.down),
        m_up(conditions, blocks_udp, 2 * seed + 1, counters.up),
        m_counters(counters) {}

  /// Waits for packets and delivers those that are due, for at most `limit`.
  void run(Nanoseconds limit) {
    const Nanoseconds until = monotonicNow() + limit;
    while (monotonicNow() < until) {
      std::array<pollfd, 2> tuns = {{{m_server_tun, POLLIN, 0}, {m_client_tun, POLLIN, 0}}};
      const timespec timeout = toTimespec(waitingTime(until));
      ppoll(tuns.data(), tuns.size(), &timeout, nullptr);
      if ((tuns[0].revents & POLLIN) != 0) read(m_server_tun, m_down);
      if ((tuns[1].revents & POLLIN) != 0) read(m_client_tun, m_up);
      deliver(m_client_tun, m_down);
      deliver(m_server_tun, m_up);
    }
  }

 private:
  static void read(int tun, Direction& direction) {
    std::array<std::uint8_t, 2048> packet{};
    for (;;) {
      const ssize_t size = ::read(tun, packet.data(), packet.size());
      if (size <= 0) return;
      direction.take({packet.data(), static_cast<std::size_t>(size)}, monotonicNow());
    }
  }
  void deliver(int tun, Direction& direction) {
    for (;;) {
      const Nanoseconds now = monotonicNow();
      const Direction::Delivery delivery = direction.pop(now);
      if (delivery.packet.empty()) return;
      // The write fails if the network has just ended, which its owner notices.
      [[maybe_unused]] const ssize_t taken = write(tun, delivery.packet.data(), delivery.packet.size());
      const auto step = static_cast<std::size_t>((now - delivery.due).count() / LinkCounters::kLateStepNanos);
      ++m_counters.late[std::min(step, LinkCounters::kLateSteps - 1)];
    }
  }
  Nanoseconds waitingTime(Nanoseconds until) const {
    Nanoseconds next = until;
    if (const auto due = m_down.next()) next = std::min(next, *due);
    if (const auto due = m_up.next()) next = std::min(next, *due);
    return std::max(next - monotonicNow(), Nanoseconds(0));
  }

  int m_server_tun;
  int m_client_tun;
  Direction m_down;
  Direction m_up;
  LinkCounters& m_counters;
};

}  // namespace bench::path
