// A SnapshotSender with a hand-made world and a client that gets every packet.
#pragma once

#include <gtest/gtest.h>

#include <map>
#include <vector>

#include "host/snapshot/SnapshotSender.h"
#include "shared/replica/Replica.h"
#include "tests/support/CellsAt.h"

namespace naiad::test {

/// Connects a sender and a replica without a network; the test sends acknowledgements itself.
class DirectSender {
 public:
  explicit DirectSender(std::size_t objects) {
    m_view.boundary = {cellsAt(0, 0), cellsAt(80, 24)};
    player.id = 1;
    m_view.players.push_back(player);
    for (std::uint32_t slot = 0; slot < objects; ++slot) {
      df::ObjectFacts facts;
      facts.key = {slot, 1};
      facts.order = slot + 1;
      facts.position = cellsAt(slot % 80, slot % 24);
      m_view.changed.push_back(facts);
    }
  }

  df::WorldView& view() { return m_view; }
  std::vector<SnapshotSender::Packet> tick(PacketLimits limits = {}) {
    skip();
    std::vector<SnapshotSender::Packet> packets = sender.build(publisher, limits);
    for (const SnapshotSender::Packet& packet : packets) read(packet);
    return packets;
  }
  void skip() {
    ++m_view.tick;
    m_view.players[0] = player;
    publisher.update(m_view);
    m_view.changed.clear();
    m_view.vanished.clear();
    sender.applyTick(publisher, player);
  }
  /// Returns the records of a packet from tick(), as a client with all earlier packets reads them.
  const Records& decoded(const SnapshotSender::Packet& packet) const { return m_records.at(packet.number); }
  void acknowledge(std::uint32_t newest, std::uint64_t mask = ~std::uint64_t{0}) {
    sender.acknowledge({newest, mask});
  }

  const Replica& reader() const { return m_reader; }

  Publisher publisher;
  SnapshotSender sender;
  df::PlayerFacts player;

 private:
  void read(const SnapshotSender::Packet& packet) {
    Snapshot snapshot;
    ASSERT_EQ(m_reader.read(packet.bytes, snapshot), ReadResult::kOk);
    m_reader.apply(snapshot);
    EXPECT_EQ(snapshot.header.number, packet.number);
    EXPECT_EQ(snapshot.header.tick, packet.tick);
    m_records[packet.number] = snapshot.records;
  }

  df::WorldView m_view;
  Replica m_reader;
  std::map<std::uint32_t, Records> m_records;  ///< index: snapshot number
};

}  // namespace naiad::test
