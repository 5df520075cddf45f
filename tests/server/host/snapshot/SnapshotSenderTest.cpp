#include <gtest/gtest.h>

#include <vector>

#include "DirectSender.h"
#include "SimulatedWorld.h"
#include "host/snapshot/SnapshotBuilder.h"
#include "host/snapshot/SnapshotSender.h"
#include "tests/support/CellsAt.h"

namespace naiad {
namespace {

using test::cellsAt;
using test::DirectSender;

// A level is loaded, with the limits that a session has for datagrams.
TEST(SnapshotSender, Sends700MovingBirthsInThreeTicks) {
  DirectSender direct(0);
  direct.tick();
  direct.acknowledge(1);
  SplitMix64 rng(700);
  const auto fraction = [&rng] { return static_cast<df::Fixed>(rng.below(df::kFixedOne)); };
  const auto cells = [&rng](std::uint32_t most) { return static_cast<std::int32_t>(rng.below(most)); };
  std::vector<df::ObjectFacts> level(700);
  for (std::uint32_t slot = 0; slot < level.size(); ++slot) {
    level[slot].key = {slot, 1};
    level[slot].order = slot + 1;
    level[slot].position = {df::fromCells(8 + cells(64)) + fraction(),
                            df::fromCells(4 + cells(16)) + fraction()};
    if (slot % 5 == 0) continue;
    level[slot].velocity = {fraction() - df::kFixedOne / 2, fraction() / 2 - df::kFixedOne / 4};
  }
  for (int tick = 0; tick < 3; ++tick) {
    direct.view().changed = level;
    for (const auto& packet : direct.tick({4, kMaxDatagramSnapshot, true})) {
      EXPECT_FALSE(packet.large);
      EXPECT_LE(packet.bytes.size(), kMaxDatagramSnapshot);
    }
    for (df::ObjectFacts& facts : level) facts.position = facts.position + facts.velocity;
  }
  EXPECT_EQ(direct.reader().aliveCount(), 700u);
}

TEST(SnapshotSender, SendsAnEmptySnapshotEveryFifthTick) {
  DirectSender direct(3);
  ASSERT_EQ(direct.tick().size(), 1u);
  direct.acknowledge(1);
  EXPECT_TRUE(direct.sender.isSettled());
  for (int i = 1; i <= 20; ++i) {
    const auto snapshots = direct.tick();
    ASSERT_EQ(snapshots.size(), i % 5 == 0 ? 1u : 0u) << "tick " << i;
    EXPECT_TRUE(snapshots.empty() || direct.decoded(snapshots[0]).objects.empty());
  }
}

TEST(SnapshotSender, AcknowledgementsOfWhatWasNeverSentAreIgnored) {
  DirectSender direct(200);
  const auto snapshots = direct.tick();
  const auto sent = static_cast<std::uint32_t>(snapshots.size());
  for (const std::uint32_t lie :
       {sent + 1, sent + 100, 0x7FFFFFFFu, 0x80000000u, 0x80000001u, 0xFFFFFFFFu, 0u}) {
    direct.acknowledge(lie);
    EXPECT_FALSE(direct.sender.isSettled()) << lie;
  }
  EXPECT_EQ(direct.sender.resentCount(), 0u);
  direct.acknowledge(sent);
  EXPECT_TRUE(direct.sender.isSettled());
}

TEST(SnapshotSender, AnyAcknowledgementsAreHarmless) {
  SplitMix64 rng(8);
  for (int run = 0; run < 50; ++run) {
    test::SimulatedWorld world({}, static_cast<std::uint64_t>(run));
    Publisher publisher;
    SnapshotSender sender;
    for (int i = 0; i < 60; ++i) {
      world.tick();
      publisher.update(world.view());
      sender.applyTick(publisher, world.view().players[0]);
      for (const auto& packet : sender.build(publisher)) {
        ASSERT_LE(packet.bytes.size(), packet.large ? kMaxSnapshot : kMaxDatagramSnapshot);
      }
      for (auto n = rng.below(4); n > 0; --n) {
        sender.acknowledge(
            {static_cast<std::uint32_t>(rng.below(5) == 0 ? rng.next() : rng.below(120)), rng.next()});
      }
    }
  }
}

TEST(SnapshotSender, SendsNoMoreThanAskedAndTheRestLater) {
  DirectSender direct(1500);
  EXPECT_EQ(direct.tick({3, 1000, true}).size(), 3u);
  EXPECT_EQ(direct.sender.build(direct.publisher, {2, 1000, true}).size(), 2u);
  EXPECT_GT(direct.sender.build(direct.publisher).size(), 4u);
  EXPECT_TRUE(direct.sender.build(direct.publisher).empty());
}

TEST(SnapshotSender, AProbeCarriesNothingAndMayBeLost) {
  DirectSender direct(3);
  direct.tick();
  direct.acknowledge(1);
  const SnapshotSender::Packet probe = direct.sender.probe(direct.publisher);
  Snapshot snapshot;
  ASSERT_EQ(direct.reader().read(probe.bytes, snapshot), ReadResult::kOk);
  EXPECT_EQ(snapshot.header.number, 2u);
  EXPECT_EQ(probe.number, 2u);
  EXPECT_EQ(snapshot.header.tick, direct.publisher.tick());
  EXPECT_TRUE(snapshot.header.complete);
  EXPECT_TRUE(snapshot.records.objects.empty());
  EXPECT_TRUE(direct.sender.isSettled());
  for (std::uint32_t number = 3; number < 8; ++number) {
    while (direct.tick().empty()) {
    }
    direct.acknowledge(number, (1u << (number - 3)) - 1);  // all except the probe
  }
  EXPECT_EQ(direct.sender.loss(), 0);
  EXPECT_EQ(direct.sender.resentCount(), 0u);
}

TEST(SnapshotSender, LossOfPendingChangesIsNotADivergence) {
  DirectSender direct(1);
  direct.tick();
  direct.acknowledge(1);
  const std::uint64_t before = direct.reader().checksum();
  direct.view().vanished.push_back({0, 1});
  df::ObjectFacts second_object;
  second_object.key = {1, 1};
  second_object.order = 2;
  second_object.position = cellsAt(3, 3);
  direct.view().changed.push_back(second_object);
  const auto second = direct.tick();  // a death and a birth, in a snapshot that is lost
  ASSERT_EQ(second.size(), 1u);
  const auto third = direct.sender.probe(direct.publisher).number;
  const auto fourth = direct.sender.probe(direct.publisher).number;
  const auto fifth = direct.sender.probe(direct.publisher).number;
  direct.view().vanished.push_back({1, 1});
  direct.skip();  // the death of the second object is pending and not yet sent
  const AckWindow acks{fifth, 0b1011};
  ASSERT_TRUE(acks.has(fourth) && acks.has(third) && !acks.has(second[0].number) && acks.has(1));
  direct.acknowledge(acks.newest, acks.mask);
  EXPECT_NE(direct.sender.matchesChecksum(acks, before), std::optional<bool>(false));
}

TEST(SnapshotSender, AResetNamesTheNewestInputAgain) {
  DirectSender direct(1);
  direct.sender.setNewestInput(7, 1);
  direct.tick();
  direct.sender.reset();
  direct.skip();
  const auto packets = direct.sender.build(direct.publisher);
  ASSERT_FALSE(packets.empty());
  Snapshot snapshot;
  ASSERT_EQ(Replica::continuing(direct.reader().newest()).read(packets[0].bytes, snapshot), ReadResult::kOk);
  EXPECT_TRUE(snapshot.header.has_input);
  EXPECT_EQ(snapshot.header.input, 7u);
}

/// A row of pending objects through the middle of a view of 80 by 24 cells.
class PendingQueueTest : public testing::Test {
 protected:
  PendingQueueTest() {
    view.boundary = {test::cellsAt(0, 0), test::cellsAt(80, 24)};
    view.players.emplace_back();
    for (std::uint32_t slot = 0; slot < 8; ++slot) {
      df::ObjectFacts facts;
      facts.key = {slot, 1};
      facts.position = test::cellsAt(10 * slot, 12);
      view.changed.push_back(facts);
    }
    view.tick = 1;
    publisher.update(view);
    replica.state.applyTick(publisher, view.players[0]);
    for (std::uint32_t slot = 0; slot < 8; ++slot) replica.objects.addObject(slot, 1, 1);
  }
  std::vector<std::uint32_t> order(std::size_t limit) {
    std::vector<std::uint32_t> ids;
    for (queue.fill(replica, publisher, limit); !queue.empty(); queue.pop()) ids.push_back(queue.front());
    return ids;
  }

  df::WorldView view;
  Publisher publisher;
  ClientReplica replica;
  PendingQueue queue;
};

TEST_F(PendingQueueTest, ObjectsThatAllFitAreOrderedById) {
  EXPECT_EQ(order(kMaxSnapshot), (std::vector<std::uint32_t>{0, 1, 2, 3, 4, 5, 6, 7}));
}

TEST_F(PendingQueueTest, LimitedQueueIsSortedByDistanceFromTheMiddle) {
  EXPECT_EQ(order(100), (std::vector<std::uint32_t>{4, 3, 5, 2, 6, 1, 7, 0}));
}

TEST_F(PendingQueueTest, DeathsAndTheFollowedObjectComeFirst) {
  view.players[0].followed = {7, 1};
  replica.state.applyTick(publisher, view.players[0]);
  replica.objects.markSent(0, 1, publisher.find(0)->state, publisher.find(0)->state.motion, 1);
  replica.objects.trimPending();
  replica.objects.removeObject(0, 1);
  const std::vector<std::uint32_t> ids = order(100);
  EXPECT_EQ(std::vector<std::uint32_t>(ids.begin(), ids.begin() + 3), (std::vector<std::uint32_t>{0, 7, 4}));
}

TEST_F(PendingQueueTest, DeferredObjectsComeBackFirst) {
  queue.fill(replica, publisher, kMaxSnapshot);
  queue.defer();
  queue.defer();
  EXPECT_EQ(queue.front(), 2u);
  queue.restoreDeferred();
  EXPECT_EQ(queue.front(), 0u);
  queue.pop();
  EXPECT_EQ(queue.front(), 1u);
}

}  // namespace
}  // namespace naiad
