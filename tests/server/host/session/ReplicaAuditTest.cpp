// The picture audit over a bad network: a correct server has no wrong cell, a faulty one has some.
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "host/session/ReplicaAudit.h"
#include "host/snapshot/Publisher.h"
#include "host/snapshot/SnapshotSender.h"
#include "shared/replica/Replica.h"
#include "shared/replica/UpdateCodec.h"
#include "tests/server/host/snapshot/SimulatedWorld.h"
#include "tests/support/net/LossyLink.h"
#include "tests/support/net/VirtualClock.h"

namespace naiad {
namespace {

using namespace std::chrono_literals;

/// A server that audits its client, connected by a bad network.
class AuditedPair {
 public:
  /// `begins`: true if the audit starts with the first world.
  AuditedPair(const LinkConditions& conditions, std::uint64_t seed, bool begins = true)
      : m_world(config(), seed),
        m_link(m_clock, conditions, seed),
        m_server_end(m_link.takeEnd(LinkEnd::kServer)),
        m_client_end(m_link.takeEnd(LinkEnd::kClient)) {
    m_server_end->start([this](std::string_view packet) { serverHears(packet); });
    m_client_end->start([this](std::string_view packet) { clientHears(packet); });
    if (begins) audit.restart();
  }

  /// `hides`: true to withhold some changes from the publisher, as if it were faulty.
  void tick(bool hides = false) {
    m_world.tick();
    df::WorldView view = m_world.view();
    if (hides) hideSome(view);
    m_publisher.update(view);
    audit.recordTruth(m_publisher.tick(), m_world.picture(0));
    sender.applyTick(m_publisher, view.players[0]);
    audit.beginTick(sender.newestNumber(), m_publisher.tick());
    for (const SnapshotSender::Packet& packet : sender.build(m_publisher)) {
      audit.recordSent(packet);
      packet.large ? m_late.push_back(packet.bytes) : m_server_end->send(packet.bytes);
    }
    m_clock.advanceBy(33'333us);
    for (const std::string& bytes : std::exchange(m_late, {})) clientHears(bytes);
  }
  void resetWorld() {
    sender.reset();
    audit.restart();
    m_client = Replica::continuing(m_client.newest());
    m_epoch = sender.epoch();
  }

  Counters counters;
  ReplicaAudit audit{counters};
  SnapshotSender sender{Resend::kAhead};

 private:
  static test::WorldConfig config() {
    test::WorldConfig config;
    config.objects = 30;
    config.vanish = 0.02;
    return config;
  }

  // Hides changes of motion and look, so objects seem to continue. Births and deaths are not hidden.
  void hideSome(df::WorldView& view) {
    std::erase_if(view.changed, [this](const df::ObjectFacts& facts) {
      return m_publisher.find(facts.key.slot) != nullptr &&
             m_publisher.find(facts.key.slot)->generation == facts.key.generation;
    });
    view.drawn.clear();
    view.commands.clear();
    view.looks.clear();
  }

  void serverHears(std::string_view packet) {
    const auto update = readUpdate(packet, {sender.newestNumber(), m_publisher.tick(), 0});
    ASSERT_TRUE(update);
    sender.acknowledge(update->acks);
    audit.acknowledge(update->acks, sender);
  }

  void clientHears(std::string_view packet) {
    if (peekEpoch(packet) != m_epoch) return;
    Snapshot snapshot;
    const ReadResult result = m_client.read(packet, snapshot);
    ASSERT_NE(result, ReadResult::kMalformed);
    if (result == ReadResult::kStale) return;
    m_client.apply(snapshot);
    m_acks.addReceived(snapshot.header.number);
    ClientUpdate update;
    update.acks = m_acks;
    m_client_end->send(writeUpdate(update));
  }

  VirtualClock m_clock;
  test::SimulatedWorld m_world;
  Publisher m_publisher;
  LossyDatagramLink m_link;
  std::unique_ptr<DatagramChannel> m_server_end;
  std::unique_ptr<DatagramChannel> m_client_end;
  Replica m_client;
  std::uint8_t m_epoch = 0;
  AckWindow m_acks;
  std::vector<std::string> m_late;
};

LinkConditions bad() {
  LinkConditions conditions;
  conditions.loss = 0.1;
  conditions.duplicate = 0.05;
  conditions.delay = 40ms;
  conditions.jitter = 60ms;
  return conditions;
}

TEST(ReplicaAudit, BadLineCausesNoWrongCells) {
  std::uint64_t pictures = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    AuditedPair pair(bad(), seed);
    for (int i = 0; i < 300 && !testing::Test::HasFatalFailure(); ++i) pair.tick();
    EXPECT_EQ(pair.counters.wrong_cells, 0u);
    EXPECT_EQ(pair.counters.audited_cells, pair.counters.audited_pictures * 40 * 20);
    pictures += pair.counters.audited_pictures;
  }
  EXPECT_GT(pictures, 400u);
}

TEST(ReplicaAudit, UnpublishedChangeIsDetected) {
  AuditedPair pair({}, 1);
  for (int i = 0; i < 200; ++i) pair.tick();
  ASSERT_EQ(pair.counters.wrong_cells, 0u);
  ASSERT_GT(pair.counters.audited_pictures, 100u) << "most are compared on a good line";
  for (int i = 0; i < 60; ++i) pair.tick(true);
  EXPECT_GT(pair.counters.wrong_cells, 0u);
}

TEST(ReplicaAudit, ContinuesAfterTheWorldIsReset) {
  AuditedPair pair({}, 2);
  for (int i = 0; i < 60; ++i) pair.tick();
  const std::uint64_t before = pair.counters.audited_pictures;
  pair.resetWorld();
  for (int i = 0; i < 60; ++i) pair.tick();
  EXPECT_GT(pair.counters.audited_pictures, before + 20);
  EXPECT_EQ(pair.counters.wrong_cells, 0u);
}

TEST(ReplicaAudit, WaitsForTheBeginningOfAWorld) {
  AuditedPair pair({}, 3, false);
  for (int i = 0; i < 60; ++i) pair.tick();
  EXPECT_EQ(pair.counters.audited_pictures, 0u);
  pair.resetWorld();
  for (int i = 0; i < 60; ++i) pair.tick();
  EXPECT_GT(pair.counters.audited_pictures, 20u);
}

TEST(ReplicaAudit, SmallTerminalIsNotAudited) {
  AuditedPair pair({}, 4);
  pair.sender.setTerminal(20, 10);
  for (int i = 0; i < 100; ++i) pair.tick();
  EXPECT_EQ(pair.counters.audited_pictures, 0u);
  EXPECT_EQ(pair.counters.wrong_cells, 0u);
}

}  // namespace
}  // namespace naiad
