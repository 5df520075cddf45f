// A server and a client that are connected by a bad network.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "host/snapshot/Publisher.h"
#include "host/snapshot/SnapshotSender.h"
#include "shared/replica/Replica.h"
#include "shared/replica/SnapshotCodec.h"
#include "shared/replica/UpdateCodec.h"
#include "tests/server/host/snapshot/SimulatedWorld.h"
#include "tests/support/net/LossyLink.h"
#include "tests/support/net/VirtualClock.h"

namespace naiad::test {

/// Snapshots and acknowledgements travel as schema messages, in datagrams of at most 1200 bytes.
class LossyScene {
 public:
  LossyScene(const WorldConfig& config, const LinkConditions& conditions, std::uint64_t seed, Resend resend)
      : sender(resend),
        world(config, seed),
        m_link(m_clock, conditions, seed),
        m_server_end(m_link.takeEnd(LinkEnd::kServer)),
        m_client_end(m_link.takeEnd(LinkEnd::kClient)) {
    m_server_end->start([this](std::string_view packet) { serverHears(packet); });
    m_client_end->start([this](std::string_view packet) { clientHears(packet); });
  }
  virtual ~LossyScene() = default;

  void tick(bool quiet = false) {
    world.tick(quiet);
    publish();
    for (const SnapshotSender::Packet& packet : sender.build(publisher)) {
      onSent(packet);
      // Packets too large for a datagram would use the stream; here they arrive late.
      packet.large ? m_late.push_back(packet.bytes) : m_server_end->send(packet.bytes);
    }
    m_clock.advanceBy(std::chrono::microseconds(33'333));
    for (const std::string& bytes : std::exchange(m_late, {})) clientHears(bytes);
  }
  /// Runs ticks until the test has failed.
  void play(int ticks, bool quiet = false) {
    for (int i = 0; i < ticks && !testing::Test::HasFatalFailure(); ++i) tick(quiet);
  }
  void setConditions(const LinkConditions& conditions) {
    m_link.setConditions(LinkEnd::kServer, conditions);
    m_link.setConditions(LinkEnd::kClient, conditions);
  }
  const LinkCounters& down() const { return m_link.counters(LinkEnd::kServer); }

  SnapshotSender sender;
  Replica replica;

 protected:
  virtual void publish() {
    publisher.update(world.view());
    sender.applyTick(publisher, world.view().players[0]);
  }
  virtual void onSent(const SnapshotSender::Packet& /*packet*/) {}
  virtual void onApplied(std::uint32_t /*snapshot_number*/) {}
  virtual void onAcknowledged(const ClientUpdate& /*update*/) {}

  SimulatedWorld world;
  Publisher publisher;
  AckWindow acks;  ///< snapshots that the client has received

 private:
  void serverHears(std::string_view packet) {
    const auto update = readUpdate(packet, {sender.newestNumber(), publisher.tick(), 0});
    ASSERT_TRUE(update);
    sender.acknowledge(update->acks);
    onAcknowledged(*update);
  }
  void clientHears(std::string_view packet) {
    if (peekEpoch(packet) != sender.epoch()) return;  // of an earlier world
    Snapshot snapshot;
    const ReadResult result = replica.read(packet, snapshot);
    ASSERT_NE(result, ReadResult::kMalformed);
    if (result == ReadResult::kStale) return;
    replica.apply(snapshot);
    onApplied(snapshot.header.number);
    acks.addReceived(snapshot.header.number);
    ClientUpdate update;
    update.acks = acks;
    update.checksum = replica.checksum();
    m_client_end->send(writeUpdate(update));
  }

  VirtualClock m_clock;
  LossyDatagramLink m_link;
  std::unique_ptr<DatagramChannel> m_server_end;
  std::unique_ptr<DatagramChannel> m_client_end;
  std::vector<std::string> m_late;
};

}  // namespace naiad::test
