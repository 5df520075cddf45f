// The picture audit over a bad network: a correct server has no wrong cell, a faulty one has some.
#include <gtest/gtest.h>

#include "host/session/ReplicaAudit.h"
#include "tests/server/host/snapshot/LossyScene.h"

namespace naiad {
namespace {

using namespace std::chrono_literals;

/// A server that audits its client.
class AuditedPair : public test::LossyScene {
 public:
  /// `begins`: true if the audit starts with the first world.
  AuditedPair(const LinkConditions& conditions, std::uint64_t seed, bool begins = true)
      : LossyScene({.objects = 30, .vanish = 0.02}, conditions, seed, Resend::kAhead) {
    if (begins) audit.restart();
  }

  void resetWorld() {
    sender.reset();
    audit.restart();
    replica = Replica::continuing(replica.newest());
  }

  Counters counters;
  ReplicaAudit audit{counters};
  bool hides = false;  ///< withholds some changes from the publisher, as if it were faulty

 private:
  void publish() override {
    df::WorldView view = world.view();
    if (hides) hideSome(view);
    publisher.update(view);
    audit.recordTruth(publisher.tick(), world.picture(0));
    sender.applyTick(publisher, view.players[0]);
    audit.beginTick(sender.newestNumber(), publisher.tick());
  }
  void onSent(const SnapshotSender::Packet& packet) override { audit.recordSent(packet); }
  void onAcknowledged(const ClientUpdate& update) override { audit.acknowledge(update.acks, sender); }

  // Hides changes of motion and look, so objects seem to continue. Births and deaths are not hidden.
  void hideSome(df::WorldView& view) {
    std::erase_if(view.changed, [this](const df::ObjectFacts& facts) {
      return publisher.find(facts.key.slot) != nullptr &&
             publisher.find(facts.key.slot)->generation == facts.key.generation;
    });
    view.drawn.clear();
    view.commands.clear();
    view.looks.clear();
  }
};

LinkConditions bad() {
  return {.delay = 40ms, .jitter = 60ms, .loss = 0.1, .duplicate = 0.05};
}

TEST(ReplicaAudit, BadLineCausesNoWrongCells) {
  std::uint64_t pictures = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    AuditedPair pair(bad(), seed);
    pair.play(300);
    EXPECT_EQ(pair.counters.wrong_cells, 0u);
    EXPECT_EQ(pair.counters.audited_cells, pair.counters.audited_pictures * 40 * 20);
    pictures += pair.counters.audited_pictures;
  }
  EXPECT_GT(pictures, 400u);
}

TEST(ReplicaAudit, UnpublishedChangeIsDetected) {
  AuditedPair pair({}, 1);
  pair.play(200);
  ASSERT_EQ(pair.counters.wrong_cells, 0u);
  ASSERT_GT(pair.counters.audited_pictures, 100u) << "most are compared on a good line";
  pair.hides = true;
  pair.play(60);
  EXPECT_GT(pair.counters.wrong_cells, 0u);
}

TEST(ReplicaAudit, ContinuesAfterTheWorldIsReset) {
  AuditedPair pair({}, 2);
  pair.play(60);
  const std::uint64_t before = pair.counters.audited_pictures;
  pair.resetWorld();
  pair.play(60);
  EXPECT_GT(pair.counters.audited_pictures, before + 20);
  EXPECT_EQ(pair.counters.wrong_cells, 0u);
}

TEST(ReplicaAudit, WaitsForTheBeginningOfAWorld) {
  AuditedPair pair({}, 3, false);
  pair.play(60);
  EXPECT_EQ(pair.counters.audited_pictures, 0u);
  pair.resetWorld();
  pair.play(60);
  EXPECT_GT(pair.counters.audited_pictures, 20u);
}

TEST(ReplicaAudit, SmallTerminalIsNotAudited) {
  AuditedPair pair({}, 4);
  pair.sender.setTerminal(20, 10);
  pair.play(100);
  EXPECT_EQ(pair.counters.audited_pictures, 0u);
  EXPECT_EQ(pair.counters.wrong_cells, 0u);
}

}  // namespace
}  // namespace naiad
