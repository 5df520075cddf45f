// The sender over a bad network: the replica becomes correct whatever was lost.
#include <gtest/gtest.h>

#include <map>
#include <vector>

#include "LossyScene.h"
#include "tests/support/Sanitizers.h"

namespace naiad {
namespace {

using namespace std::chrono_literals;

class LossyPair : public test::LossyScene {
 public:
  LossyPair(const test::WorldConfig& config, const LinkConditions& conditions, std::uint64_t seed,
            Resend resend = Resend::kOnGap)
      : LossyScene(config, conditions, seed, resend) {}

  /// Checks that the replica holds exactly what was sent and draws what the world draws.
  void expectSame() {
    std::size_t alive = 0;
    const std::uint32_t tick = publisher.tick();
    sender.known().forEachAlive([&](std::uint32_t id, const KnownObjects::Known& known) {
      ++alive;
      const Publisher::Model& model = *publisher.find(known.slot);
      const Replica::ReplicaObject* entry = replica.find(id);
      ASSERT_NE(entry, nullptr) << "object " << id << " is missing";
      ASSERT_EQ(known.generation, model.generation) << "object " << id;
      EXPECT_EQ(entry->state.order, model.state.order);
      EXPECT_TRUE(rebase(entry->state.look, tick) == rebase(model.state.look, tick)) << "object " << id;
      EXPECT_TRUE(entry->state.body == model.state.body) << "object " << id;
      EXPECT_EQ(rebase(entry->state.motion, tick), rebase(model.state.motion, tick)) << "object " << id;
    });
    ASSERT_EQ(replica.aliveCount(), alive) << "ghosts";
    EXPECT_EQ(sender.known().checksum(), replica.checksum());
    EXPECT_NE(sender.matchesChecksum(acks, replica.checksum()), std::optional(false));
    const df::Canvas wanted = world.picture(0);
    const df::Canvas seen = replica.render(tick);
    ASSERT_EQ(countDifferences(wanted, seen), 0) << test::explain(wanted, seen);
  }

  /// Lets the link be perfect and the world quiet for these ticks, after which all must be right.
  void heal(int ticks) {
    setConditions({});
    play(ticks, true);
    EXPECT_TRUE(sender.isSettled());
    expectSame();
  }

  std::size_t snapshots = 0;
  std::size_t reuses = 0;  ///< births under an id that was used before
  std::size_t checks = 0;  ///< number of checksums compared

 private:
  void onSent(const SnapshotSender::Packet& packet) override {
    ++snapshots;
    std::vector<std::uint32_t>& lives = m_births[packet.number];
    for (std::uint32_t id = 0; id < sender.known().idCount(); ++id)
      lives.push_back(sender.known().at(id).birth);
    ASSERT_LE(packet.bytes.size(), packet.large ? kMaxSnapshot : kMaxDatagramSnapshot);
  }
  void onAcknowledged(const ClientUpdate& update) override {
    const auto right = sender.matchesChecksum(update.acks, *update.checksum);
    checks += right ? 1 : 0;
    ASSERT_NE(right, std::optional(false)) << "after snapshot " << update.acks.newest;
  }
  // Checks that no object is born twice: an object that the replica has removed must not come back to life.
  void onApplied(std::uint32_t number) override {
    for (const auto& [id, entry] : replica.entries()) {
      const auto was = m_alive.find(id);
      const bool alive = was != m_alive.end() && was->second;
      if (entry.alive && !alive) {
        const std::uint32_t life = m_births.at(number).at(id);
        const auto before = m_lives.find(id);
        if (before != m_lives.end()) {
          ASSERT_LT(before->second, life) << "object " << id << " came back to life";
          ++reuses;
        }
        m_lives[id] = life;
      }
      m_alive[id] = entry.alive;
    }
  }

  std::map<std::uint32_t, bool> m_alive;           ///< keyed by id
  std::map<std::uint32_t, std::uint32_t> m_lives;  ///< number of objects that have used an id
  std::map<std::uint32_t, std::vector<std::uint32_t>>
      m_births;  ///< m_lives as each snapshot was sent, by its number and by id
};

TEST(SnapshotLoss, EveryReplicaIsRightOnceABadLinkHeals) {
  std::uint64_t lost = 0;
  std::uint64_t reordered = 0;
  std::uint64_t duplicated = 0;
  std::uint64_t resent = 0;
  std::size_t reuses = 0;
  std::size_t checks = 0;
  for (std::uint64_t seed = 0; seed < 240 / test::kShare; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    SplitMix64 rng(seed);
    LinkConditions bad{.loss = rng.unit() * 0.3, .duplicate = rng.unit() * 0.2};
    bad.delay = std::chrono::microseconds(rng.below(150'000));
    bad.jitter = std::chrono::microseconds(rng.below(120'000));
    const test::WorldConfig config{.objects = 5 + rng.below(60), .turn = 0.05, .vanish = 0.02};
    LossyPair pair(config, bad, seed, static_cast<Resend>(seed % 3));
    pair.play(150);
    pair.heal(40);
    if (testing::Test::HasFailure()) return;
    lost += pair.down().dropped;
    reordered += pair.down().reordered;
    duplicated += pair.down().duplicated;
    resent += pair.sender.resentCount();
    reuses += pair.reuses;
    checks += pair.checks;
  }
  constexpr std::uint64_t kMany = 1000 / test::kShare;
  EXPECT_GT(lost, kMany);
  EXPECT_GT(reordered, kMany);
  EXPECT_GT(duplicated, kMany);
  EXPECT_GT(resent, kMany);
  EXPECT_GT(reuses, kMany);
  EXPECT_GT(checks, kMany);
}

TEST(SnapshotLoss, FollowingViewsAreRightOnceABadLinkHeals) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const test::WorldConfig config{
        .width = 300, .height = 120, .objects = 6, .turn = 0.1, .block = 0.1, .vanish = 0.002};
    LossyPair pair(config, {.delay = 60ms, .loss = 0.3}, seed, static_cast<Resend>(seed % 3));
    pair.play(100);
    pair.setConditions({});
    // The replica is correct as soon as everything has arrived, not only after the next correction.
    for (int i = 0; i < 40 && !testing::Test::HasFatalFailure(); ++i) {
      pair.tick(true);
      if (pair.sender.isSettled()) pair.expectSame();
    }
    EXPECT_TRUE(pair.sender.isSettled());
    if (testing::Test::HasFailure()) return;
  }
}

TEST(SnapshotLoss, NothingIsSentTwiceWhereNothingIsLost) {
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const LinkConditions slow{.delay = std::chrono::milliseconds(10 * (seed % 16)),
                              .jitter = 20ms,
                              .reorder = false,
                              .duplicate = 0.1};
    LossyPair pair({.objects = 60}, slow, seed);
    pair.play(150);
    EXPECT_EQ(pair.sender.resentCount(), 0u);
    pair.setConditions({});
    pair.play(20, true);
    pair.expectSame();
    if (testing::Test::HasFailure()) return;
  }
}

TEST(SnapshotLoss, AWorldLargerThanTheWindowArrivesWithoutResending) {
  test::WorldConfig config{.width = 40, .height = 20, .objects = 12000};
  config.turn = config.block = config.restyle = config.vanish = config.hide = config.reshape = 0;
  LossyPair pair(config, {.delay = 70ms}, 1);
  pair.tick();
  pair.play(59, true);
  EXPECT_GT(pair.snapshots, 2 * SnapshotSender::kMaxInFlight);
  EXPECT_EQ(pair.sender.resentCount(), 0u);
  pair.heal(10);
}

TEST(SnapshotLoss, ALinkThatWasDeadForSecondsRecovers) {
  LossyPair pair({}, {}, 3);
  pair.play(20);
  pair.setConditions({.loss = 1});
  pair.play(300);
  pair.heal(20);
}

}  // namespace
}  // namespace naiad
