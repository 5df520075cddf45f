// One client of a published world: its sender on the server, a bad line in virtual time, and its replica.
// Counts bytes as on a real line: with IPv4 and UDP headers, the datagram's header, and its seal.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string_view>

#include "client/world/DisplayClock.h"
#include "host/snapshot/Publisher.h"
#include "host/snapshot/SnapshotSender.h"
#include "shared/replica/Replica.h"
#include "tests/support/net/LossyLink.h"
#include "tests/support/net/VirtualClock.h"

namespace bench {

class LinkedClient {
 public:
  /// Bytes around a snapshot: IPv4 and UDP headers, the datagram's header, its seal, its flags.
  static constexpr std::size_t kDownOverhead = 28 + 3 + 16 + 1;
  static constexpr std::size_t kUpOverhead = 28 + 11 + 16 + 1;
  using Time = naiad::DisplayClock::Time;

  LinkedClient(naiad::VirtualClock& clock, const naiad::LinkConditions& conditions, std::uint64_t seed,
               naiad::Resend resend);

  /// Runs a tick of the server.
  void tick(const naiad::Publisher& publisher, const df::PlayerFacts& player);
  /// Called for each snapshot that arrives, before it is applied.
  std::function<void(const naiad::Snapshot&)> on_snapshot;

  const naiad::Replica& replica() const { return m_replica; }
  naiad::DisplayClock& displayClock() { return m_display; }
  /// Returns the present virtual time as a time for the display clock.
  Time now() const { return Time{} + m_clock.now(); }

  /// Measured since the last resetFigures(): bytes on the line, and times.
  std::size_t bytes_down = 0;
  std::size_t bytes_up = 0;
  std::size_t packets_down = 0;
  std::chrono::steady_clock::duration encode{};
  void resetFigures();

 private:
  void serverHears(std::string_view bytes);
  void clientHears(std::string_view bytes);

  naiad::VirtualClock& m_clock;
  naiad::SnapshotSender m_sender;
  naiad::Replica m_replica;
  naiad::AckWindow m_acks;
  naiad::DisplayClock m_display;
  std::uint32_t m_tick = 0;
  naiad::LossyDatagramLink m_link;
  std::unique_ptr<naiad::DatagramChannel> m_server;
  std::unique_ptr<naiad::DatagramChannel> m_client;
};

/// Length of a tick in these measurements.
inline constexpr std::chrono::microseconds kTickLength{33'333};

}  // namespace bench
