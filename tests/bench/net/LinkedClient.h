// One client of a published world: its sender on the server, a bad line in virtual time, and its replica.
// Counts bytes as on a real line: with IPv4 and UDP headers, the datagram's header, and its seal.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "client/world/DisplayClock.h"
#include "host/snapshot/Publisher.h"
#include "host/snapshot/SnapshotSender.h"
#include "shared/replica/Replica.h"
#include "shared/replica/UpdateCodec.h"
#include "tests/support/net/LossyLink.h"
#include "tests/support/net/VirtualClock.h"

namespace bench {

using namespace naiad;

/// Length of a tick in these measurements.
inline constexpr std::chrono::microseconds kTickLength{33'333};

class LinkedClient {
 public:
  /// Bytes around a snapshot: IPv4 and UDP headers, the datagram's header, its seal, its flags.
  static constexpr std::size_t kDownOverhead = 28 + 3 + 16 + 1;
  static constexpr std::size_t kUpOverhead = 28 + 11 + 16 + 1;
  using Time = DisplayClock::Time;

  LinkedClient(VirtualClock& clock, const LinkConditions& conditions, std::uint64_t seed, Resend resend)
      : m_clock(clock),
        m_sender(resend),
        m_display(kTickLength),
        m_link(clock, conditions, seed),
        m_server(m_link.takeEnd(LinkEnd::kServer)),
        m_client(m_link.takeEnd(LinkEnd::kClient)) {
    m_server->start([this](std::string_view bytes) { serverHears(bytes); });
    m_client->start([this](std::string_view bytes) { clientHears(bytes); });
  }

  /// Runs a tick of the server.
  void tick(const Publisher& publisher, const df::PlayerFacts& player) {
    m_tick = publisher.tick();
    const auto begin = std::chrono::steady_clock::now();
    m_sender.applyTick(publisher, player);
    const std::vector<SnapshotSender::Packet> packets = m_sender.build(publisher);
    encode += std::chrono::steady_clock::now() - begin;
    for (const SnapshotSender::Packet& packet : packets) {
      bytes_down += packet.bytes.size() + kDownOverhead;
      ++packets_down;
      m_server->send(packet.bytes);
    }
  }
  /// Called for each snapshot that arrives, before it is applied.
  std::function<void(const Snapshot&)> on_snapshot;

  const Replica& replica() const { return m_replica; }
  DisplayClock& displayClock() { return m_display; }
  /// Returns the present virtual time as a time for the display clock.
  Time now() const { return Time{} + m_clock.now(); }

  /// Measured since the last resetFigures(): bytes on the line, and times.
  std::size_t bytes_down = 0;
  std::size_t bytes_up = 0;
  std::size_t packets_down = 0;
  std::chrono::steady_clock::duration encode{};
  void resetFigures() {
    bytes_down = bytes_up = packets_down = 0;
    encode = {};
  }

 private:
  void serverHears(std::string_view bytes) {
    const auto update = readUpdate(bytes, {m_sender.newestNumber(), m_tick, 0});
    if (!update) throw std::logic_error("an update that cannot be read");
    m_sender.acknowledge(update->acks);
  }
  void clientHears(std::string_view bytes) {
    Snapshot snapshot;
    if (m_replica.read(bytes, snapshot) != ReadResult::kOk) return;
    if (on_snapshot) on_snapshot(snapshot);
    m_replica.apply(snapshot);
    m_acks.addReceived(snapshot.header.number);
    m_display.onSnapshot(snapshot.header.tick, now());
    ClientUpdate update;
    update.acks = m_acks;
    const std::string answer = writeUpdate(update);
    bytes_up += answer.size() + kUpOverhead;
    m_client->send(answer);
  }

  VirtualClock& m_clock;
  SnapshotSender m_sender;
  Replica m_replica;
  AckWindow m_acks;
  DisplayClock m_display;
  std::uint32_t m_tick = 0;
  LossyDatagramLink m_link;
  std::unique_ptr<DatagramChannel> m_server;
  std::unique_ptr<DatagramChannel> m_client;
};

}  // namespace bench
