#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <vector>

#include "DirectSender.h"
#include "host/snapshot/AppearanceIds.h"
#include "host/snapshot/SnapshotBuilder.h"
#include "host/snapshot/SnapshotSender.h"
#include "shared/values/SplitMix64.h"
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
    view.boundary = {cellsAt(0, 0), cellsAt(80, 24)};
    view.players.emplace_back();
    for (std::uint32_t slot = 0; slot < 8; ++slot) {
      df::ObjectFacts facts;
      facts.key = {slot, 1};
      facts.position = cellsAt(10 * slot, 12);
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

constexpr std::size_t kLargest = kMaxDictionaryGlyphs / 2 / 8;

class AppearanceIdsTest : public testing::Test {
 protected:
  /// Writes the appearance in the form that formOf() returns, and marks its id as used.
  LookForm write(std::uint64_t hash, std::uint32_t snapshot, std::size_t glyphs = 10) {
    const LookForm form = names.formOf(hash, glyphs, snapshot);
    if (form.kind != LookForm::kInline) names.markUsed(hash, snapshot);
    return form;
  }

  AppearanceIds names;
};

TEST_F(AppearanceIdsTest, DefinesUntilADefinitionArrived) {
  const LookForm first = write(111, 1);
  EXPECT_EQ(first.kind, LookForm::kDefined);
  const LookForm second = write(111, 2);
  EXPECT_EQ(second.kind, LookForm::kDefined);
  EXPECT_EQ(second.id, first.id);
  names.confirmArrival(first.id, 111, 1);
  const LookForm third = write(111, 3);
  EXPECT_EQ(third.kind, LookForm::kNamed);
  EXPECT_EQ(third.id, first.id);
}

TEST_F(AppearanceIdsTest, WithinOneSnapshotOneDefinitionIsEnough) {
  EXPECT_EQ(write(111, 1).kind, LookForm::kDefined);
  EXPECT_EQ(write(111, 1).kind, LookForm::kNamed);
  EXPECT_EQ(write(111, 2).kind, LookForm::kDefined) << "the previous one may be lost";
}

TEST_F(AppearanceIdsTest, AFormThatWasNotWrittenDefinesNothing) {
  EXPECT_EQ(names.formOf(111, 10, 1).kind, LookForm::kDefined);
  EXPECT_EQ(names.formOf(111, 10, 1).kind, LookForm::kDefined);
}

TEST_F(AppearanceIdsTest, TheLeastRecentlyUsedIdIsReassigned) {
  std::uint32_t snapshot = 0;
  std::uint32_t second = 0;
  std::set<std::uint32_t> ids;
  for (std::uint64_t hash = 1; hash <= kMaxAppearances; ++hash) {
    const LookForm form = write(hash, ++snapshot, 2);
    ASSERT_EQ(form.kind, LookForm::kDefined);
    ASSERT_TRUE(form.id < kMaxAppearances && ids.insert(form.id).second) << hash;
    names.confirmArrival(form.id, hash, snapshot);
    if (hash == 2) second = form.id;
  }
  EXPECT_EQ(write(1, ++snapshot, 2).kind, LookForm::kNamed);  // now appearance 2 is the least recently used
  const LookForm form = write(9999, ++snapshot, 2);
  EXPECT_EQ(form.kind, LookForm::kDefined);
  EXPECT_EQ(form.id, second);
  EXPECT_EQ(write(1, ++snapshot, 2).kind, LookForm::kNamed);
  EXPECT_EQ(write(2, ++snapshot, 2).kind, LookForm::kDefined);
}

TEST_F(AppearanceIdsTest, LateArrivalDoesNotConfirmAReassignedId) {
  std::uint32_t snapshot = 0;
  for (std::uint64_t hash = 1; hash <= 8; ++hash) write(hash, ++snapshot, kLargest);
  const LookForm next = write(9, ++snapshot, kLargest);  // gets the id of appearance 1
  names.confirmArrival(next.id, 1, 1);
  EXPECT_EQ(write(9, ++snapshot, kLargest).kind, LookForm::kDefined);
}

// The appearance gets its earlier id again, but the client may still have stored the one that had this id in
// between.
TEST_F(AppearanceIdsTest, AnEarlierDefinitionDoesNotConfirmALaterOne) {
  const LookForm first = write(1, 1, kLargest);
  std::uint32_t snapshot = 1;
  for (std::uint64_t hash = 2; hash <= 9; ++hash) write(hash, ++snapshot, kLargest);  // 9 gets the id of 1
  for (std::uint64_t hash = 2; hash <= 8; ++hash) write(hash, ++snapshot, kLargest);
  const LookForm again = write(1, ++snapshot, kLargest);  // gets the id of appearance 9
  ASSERT_EQ(again.id, first.id);
  names.confirmArrival(first.id, 1, 1);
  EXPECT_EQ(write(1, ++snapshot, kLargest).kind, LookForm::kDefined);
  names.confirmArrival(first.id, 1, snapshot);
  EXPECT_EQ(write(1, ++snapshot, kLargest).kind, LookForm::kNamed);
}

TEST_F(AppearanceIdsTest, TotalGlyphsAreLimited) {
  std::uint32_t snapshot = 0;
  EXPECT_EQ(write(1, ++snapshot, kLargest + 1).kind, LookForm::kInline) << "too large for a name";
  for (std::uint64_t hash = 1; hash <= 20; ++hash) {
    const LookForm form = write(hash, ++snapshot, kLargest);
    EXPECT_EQ(form.kind, LookForm::kDefined);
    EXPECT_LT(form.id, 8u) << "eight of this size are all that is known at a time";
    names.confirmArrival(form.id, hash, snapshot);
  }
  for (std::uint64_t hash = 13; hash <= 20; ++hash)
    EXPECT_EQ(write(hash, 99, kLargest).kind, LookForm::kNamed);
  EXPECT_EQ(write(12, 100, kLargest).kind, LookForm::kDefined);
}

// If an id had two, the client would draw the new appearance where the snapshot names the old one.
TEST_F(AppearanceIdsTest, AnIdHasOneMeaningInASnapshot) {
  for (std::uint64_t hash = 1; hash <= 8; ++hash) names.confirmArrival(write(hash, 1, kLargest).id, hash, 1);
  for (std::uint64_t hash = 1; hash <= 8; ++hash) EXPECT_EQ(write(hash, 2, kLargest).kind, LookForm::kNamed);
  EXPECT_EQ(write(9, 2, kLargest).kind, LookForm::kInline) << "all ids are in use";
  EXPECT_EQ(write(9, 3, kLargest).kind, LookForm::kDefined);
}

TEST_F(AppearanceIdsTest, AResetClientGetsDefinitionsAgain) {
  names.confirmArrival(write(111, 1).id, 111, 1);
  names.clear();
  EXPECT_EQ(write(111, 2).kind, LookForm::kDefined);
}

/// Objects whose births were sent in snapshot 1.
struct SentBirths {
  explicit SentBirths(std::uint32_t count = 1) {
    for (std::uint32_t i = 0; i < count; ++i) ids.push_back(known.addObject(i, 1, 1));
    for (const std::uint32_t id : ids) sent.push_back(send(id));
  }
  KnownObjects::Sent send(std::uint32_t id) {
    const KnownObjects::Sent record = known.markSent(id, snapshot, state, state.motion, snapshot);
    known.trimPending();
    return record;
  }
  /// Returns the ids that the next tick repeats, after sending them again.
  std::vector<std::uint32_t> next(std::size_t bits) {
    ++snapshot;
    redundancy.requeueRecords(known, snapshot);
    std::vector<std::uint32_t> repeated = known.pendingIds();
    for (const std::uint32_t id : repeated) redundancy.addRecord(send(id), bits, 0);
    return repeated;
  }
  KnownObjects known;
  RedundantResend redundancy;
  ObjectState state;
  std::uint32_t snapshot = 1;
  std::vector<std::uint32_t> ids;
  std::vector<KnownObjects::Sent> sent;
};

TEST(RedundantResend, LongRecordIsRepeatedOnceShortOneTwice) {
  SentBirths one;
  one.redundancy.addRecord(one.sent[0], 100, 0);
  EXPECT_EQ(one.next(100).size(), 1u);
  EXPECT_EQ(one.next(100).size(), 0u);

  SentBirths other;
  other.redundancy.addRecord(other.sent[0], RedundantResend::kShortBits, 0);
  EXPECT_EQ(other.next(RedundantResend::kShortBits).size(), 1u);
  EXPECT_EQ(other.next(RedundantResend::kShortBits).size(), 1u);
  EXPECT_EQ(other.next(RedundantResend::kShortBits).size(), 0u);
}

TEST(RedundantResend, WhatHasArrivedIsNotRepeated) {
  SentBirths one;
  one.redundancy.addRecord(one.sent[0], 20, 0);
  one.known.confirmArrival(one.sent[0], 1);
  EXPECT_EQ(one.next(20).size(), 0u);
}

TEST(RedundantResend, TheMostUrgentComeFirstAndTheBudgetHolds) {
  SentBirths many(10);
  constexpr std::size_t kEach = RedundantResend::kBits / 4;
  for (std::uint32_t i = 0; i < 10; ++i) many.redundancy.addRecord(many.sent[i], kEach, i);
  auto repeated = many.next(kEach);
  std::ranges::sort(repeated);
  EXPECT_EQ(repeated, (std::vector<std::uint32_t>{many.ids[6], many.ids[7], many.ids[8], many.ids[9]}));
}

TEST(RedundantResend, ARecordThatExceedsTheBudgetIsRepeatedAlone) {
  SentBirths two(2);
  two.redundancy.addRecord(two.sent[0], 10 * RedundantResend::kBits, 1);
  two.redundancy.addRecord(two.sent[1], 10, 0);
  EXPECT_EQ(two.next(10), std::vector<std::uint32_t>{two.ids[0]});
}

}  // namespace
}  // namespace naiad
