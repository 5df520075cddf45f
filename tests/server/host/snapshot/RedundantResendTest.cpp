#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "host/snapshot/RedundantResend.h"

namespace naiad::test {
namespace {

/// One object whose birth has been sent in snapshot 1.
struct Sent {
  explicit Sent(std::uint32_t count = 1) {
    for (std::uint32_t i = 0; i < count; ++i) ids.push_back(known.learn(i, 1, 1));
    for (const std::uint32_t id : ids) sent.push_back(pay(id));
  }
  KnownObjects::Sent pay(std::uint32_t id) {
    const KnownObjects::Sent paid = known.paid(id, snapshot, state, snapshot);
    known.sweepOwing();
    return paid;
  }
  /// Who is repeated in the next tick, and is sent again in it.
  std::vector<std::uint32_t> next(std::size_t bits) {
    ++snapshot;
    ahead.owe(known, snapshot);
    std::vector<std::uint32_t> repeated = known.owing();
    for (const std::uint32_t id : repeated) ahead.consider(pay(id), bits, 0);
    return repeated;
  }
  KnownObjects known;
  RedundantResend ahead;
  ObjectState state;
  std::uint32_t snapshot = 1;
  std::vector<std::uint32_t> ids;
  std::vector<KnownObjects::Sent> sent;
};

TEST(RedundantResend, ALongRecordIsRepeatedOnceAShortOneTwice) {
  Sent one;
  one.ahead.consider(one.sent[0], 100, 0);
  EXPECT_EQ(one.next(100).size(), 1u);
  EXPECT_EQ(one.next(100).size(), 0u);

  Sent other;
  other.ahead.consider(other.sent[0], RedundantResend::kShortBits, 0);
  EXPECT_EQ(other.next(RedundantResend::kShortBits).size(), 1u);
  EXPECT_EQ(other.next(RedundantResend::kShortBits).size(), 1u);
  EXPECT_EQ(other.next(RedundantResend::kShortBits).size(), 0u);
}

TEST(RedundantResend, WhatHasArrivedIsNotRepeated) {
  Sent one;
  one.ahead.consider(one.sent[0], 20, 0);
  one.known.arrived(one.sent[0], 1);
  EXPECT_EQ(one.next(20).size(), 0u);
}

TEST(RedundantResend, TheMostUrgentComeFirstAndTheBudgetHolds) {
  Sent many(10);
  constexpr std::size_t kEach = RedundantResend::kBits / 4;
  for (std::uint32_t i = 0; i < 10; ++i) many.ahead.consider(many.sent[i], kEach, i);
  auto repeated = many.next(kEach);
  std::sort(repeated.begin(), repeated.end());
  EXPECT_EQ(repeated, (std::vector<std::uint32_t>{many.ids[6], many.ids[7], many.ids[8], many.ids[9]}));
}

TEST(RedundantResend, OneThatExceedsTheBudgetIsRepeatedAlone) {
  Sent two(2);
  two.ahead.consider(two.sent[0], 10 * RedundantResend::kBits, 1);
  two.ahead.consider(two.sent[1], 10, 0);
  EXPECT_EQ(two.next(10), std::vector<std::uint32_t>{two.ids[0]});
}

}  // namespace
}  // namespace naiad::test
