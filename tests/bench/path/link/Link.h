// Carries packets between two networks.
#pragma once

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdint>

#include "Direction.h"

namespace bench::path {

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
