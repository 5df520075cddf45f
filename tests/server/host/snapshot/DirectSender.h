// A client that reads snapshots, and a SnapshotSender with a hand-made world whose client gets every packet.
#pragma once

#include <gtest/gtest.h>

#include <map>
#include <string_view>
#include <vector>

#include "host/snapshot/SnapshotSender.h"
#include "shared/replica/Replica.h"
#include "tests/support/CellsAt.h"

namespace naiad::test {

/// A client's replica, and its acknowledgement of what it has read.
struct SnapshotReader {
  /// Applies a snapshot, which must be well-formed.
  void read(std::string_view bytes) {
    ASSERT_EQ(replica.read(bytes, newest), ReadResult::kOk);
    replica.apply(newest);
    acks.addReceived(newest.header.number);
  }

  Replica replica;
  AckWindow acks;
  Snapshot newest;  ///< the last snapshot read
};

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

  const Replica& reader() const { return m_reader.replica; }

  Publisher publisher;
  SnapshotSender sender;
  df::PlayerFacts player;

 private:
  void read(const SnapshotSender::Packet& packet) {
    m_reader.read(packet.bytes);
    EXPECT_EQ(m_reader.newest.header.number, packet.number);
    EXPECT_EQ(m_reader.newest.header.tick, packet.tick);
    m_records[packet.number] = m_reader.newest.records;
  }

  df::WorldView m_view;
  SnapshotReader m_reader;
  std::map<std::uint32_t, Records> m_records;  ///< index: snapshot number
};

}  // namespace naiad::test
