#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "host/snapshot/SnapshotBuilder.h"

namespace naiad::test {
namespace {

/// Objects whose births were sent in snapshot 1.
struct Sent {
  explicit Sent(std::uint32_t count = 1) {
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
  Sent one;
  one.redundancy.addRecord(one.sent[0], 100, 0);
  EXPECT_EQ(one.next(100).size(), 1u);
  EXPECT_EQ(one.next(100).size(), 0u);

  Sent other;
  other.redundancy.addRecord(other.sent[0], RedundantResend::kShortBits, 0);
  EXPECT_EQ(other.next(RedundantResend::kShortBits).size(), 1u);
  EXPECT_EQ(other.next(RedundantResend::kShortBits).size(), 1u);
  EXPECT_EQ(other.next(RedundantResend::kShortBits).size(), 0u);
}

TEST(RedundantResend, WhatHasArrivedIsNotRepeated) {
  Sent one;
  one.redundancy.addRecord(one.sent[0], 20, 0);
  one.known.confirmArrival(one.sent[0], 1);
  EXPECT_EQ(one.next(20).size(), 0u);
}

TEST(RedundantResend, TheMostUrgentComeFirstAndTheBudgetHolds) {
  Sent many(10);
  constexpr std::size_t kEach = RedundantResend::kBits / 4;
  for (std::uint32_t i = 0; i < 10; ++i) many.redundancy.addRecord(many.sent[i], kEach, i);
  auto repeated = many.next(kEach);
  std::ranges::sort(repeated);
  EXPECT_EQ(repeated, (std::vector<std::uint32_t>{many.ids[6], many.ids[7], many.ids[8], many.ids[9]}));
}

TEST(RedundantResend, ARecordThatExceedsTheBudgetIsRepeatedAlone) {
  Sent two(2);
  two.redundancy.addRecord(two.sent[0], 10 * RedundantResend::kBits, 1);
  two.redundancy.addRecord(two.sent[1], 10, 0);
  EXPECT_EQ(two.next(10), std::vector<std::uint32_t>{two.ids[0]});
}

}  // namespace
}  // namespace naiad::test
