// A SnapshotSender with a world made by hand, and a client that gets all that is sent.
#pragma once

#include <gtest/gtest.h>

#include <map>
#include <vector>

#include "host/snapshot/SnapshotSender.h"
#include "shared/replica/Replica.h"
#include "shared/values/Vector.h"
#include "tests/support/CellsAt.h"

namespace naiad::test {

/// By hand, without a link.
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
  /// A tick in which nothing is sent: the client is busy.
  void skip() {
    ++m_view.tick;
    m_view.players[0] = player;
    publisher.update(m_view);
    m_view.changed.clear();
    m_view.vanished.clear();
    sender.applyTick(publisher, player);
  }
  /// The records of a packet that tick() gave, as a client reads them that got all.
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
  std::map<std::uint32_t, Records> m_records;  ///< by number
};

}  // namespace naiad::test
