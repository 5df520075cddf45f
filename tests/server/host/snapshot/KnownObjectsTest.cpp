#include <gtest/gtest.h>

#include "host/snapshot/KnownObjects.h"
#include "shared/replica/Checksum.h"

namespace naiad {
namespace {

using Life = KnownObjects::Life;
using Sent = KnownObjects::Sent;
using Ids = std::vector<std::uint32_t>;

class KnownObjectsTest : public testing::Test {
 protected:
  /// An object that the client has confirmed.
  std::uint32_t alive(std::uint32_t slot) {
    known.learn(slot, 1, 0);
    const std::uint32_t id = known.find(slot);
    confirm(id);
    return id;
  }
  /// Pay, and let it arrive.
  void confirm(std::uint32_t id) {
    ++number;
    known.arrived(pay(id, number), number);
  }
  Sent pay(std::uint32_t id, std::uint32_t snapshot) {
    const Sent sent = known.paid(id, snapshot, state, 0);
    known.sweepOwing();
    return sent;
  }
  bool isOwing(std::uint32_t id) const {
    return std::count(known.owing().begin(), known.owing().end(), id) == 1 && known.at(id).owed != 0;
  }

  KnownObjects known;
  ObjectState state;
  std::uint32_t number = 0;
};

TEST_F(KnownObjectsTest, ABirthIsOwedWholeUntilOneArrived) {
  known.learn(70, 5, 33);
  const std::uint32_t id = known.find(70);
  EXPECT_EQ(id, 0u);
  EXPECT_EQ(known.at(id).life, Life::kBorn);
  EXPECT_EQ(known.at(id).slot, 70u);
  EXPECT_EQ(known.at(id).generation, 5u);
  EXPECT_EQ(known.at(id).since, 33u);
  EXPECT_TRUE(isOwing(id));
  EXPECT_EQ(known.due(id), kAllGroups);
  const Sent first = pay(id, 1);
  EXPECT_EQ(first.groups, kAllGroups);
  EXPECT_FALSE(isOwing(id));
  EXPECT_TRUE(known.owing().empty());
  known.owe(id, kMotion, 34);
  EXPECT_TRUE(isOwing(id));
  EXPECT_EQ(known.due(id), kAllGroups) << "the client may not have heard of it";
  const Sent second = pay(id, 2);
  EXPECT_EQ(second.groups, kAllGroups);
  known.arrived(second, 2);
  EXPECT_EQ(known.at(id).life, Life::kAlive);
  EXPECT_EQ(known.at(id).unconfirmed, 0);
  known.owe(id, kMotion, 35);
  EXPECT_EQ(known.due(id), kMotion);
  EXPECT_EQ(known.at(id).since, 35u);
}

TEST_F(KnownObjectsTest, DebtsAddUp) {
  const std::uint32_t id = alive(3);
  known.owe(id, 0, 5);
  EXPECT_FALSE(isOwing(id));
  known.owe(id, kMotion, 5);
  known.owe(id, kLook, 8);
  EXPECT_TRUE(isOwing(id));
  EXPECT_EQ(known.due(id), kMotion | kLook);
  EXPECT_EQ(known.at(id).since, 5u) << "since the first of them";
}

TEST_F(KnownObjectsTest, WhatWasLostIsOwedAgain) {
  const std::uint32_t id = alive(3);
  known.owe(id, kMotion | kLook, 5);
  const Sent sent = pay(id, 10);
  EXPECT_EQ(known.at(id).unconfirmed, kMotion | kLook);
  EXPECT_TRUE(known.lost(sent, 10, 20));
  EXPECT_EQ(known.due(id), kMotion | kLook);
  EXPECT_EQ(known.at(id).since, 20u);
}

TEST_F(KnownObjectsTest, WhatWasSentAgainSinceIsNotOwedForTheOlderLoss) {
  const std::uint32_t id = alive(3);
  known.owe(id, kMotion | kLook, 5);
  const Sent first = pay(id, 10);
  known.owe(id, kMotion, 6);
  const Sent second = pay(id, 11);
  EXPECT_TRUE(known.lost(first, 10, 20));
  EXPECT_EQ(known.due(id), kLook) << "the motion is in the later one";
  pay(id, 12);
  EXPECT_FALSE(known.lost(first, 10, 21));
  EXPECT_TRUE(known.lost(second, 11, 22));
  EXPECT_EQ(known.due(id), kMotion);
}

TEST_F(KnownObjectsTest, AnOlderArrivalConfirmsNothingNewer) {
  const std::uint32_t id = alive(3);
  known.owe(id, kMotion | kLook, 5);
  const Sent first = pay(id, 10);
  known.owe(id, kMotion, 6);
  state.motion.position.x += df::kFixedOne;
  pay(id, 11);
  known.arrived(first, 10);
  EXPECT_EQ(known.at(id).unconfirmed, kMotion);
  known.oweUnconfirmed(30);
  EXPECT_EQ(known.due(id), kMotion);
}

TEST_F(KnownObjectsTest, WhatWasSentAgainAsItWasIsConfirmedByEither) {
  const std::uint32_t id = alive(3);
  known.owe(id, kMotion, 5);
  const Sent first = pay(id, 10);
  known.owe(id, kMotion, 6);
  const Sent again = pay(id, 11);
  known.arrived(first, 10);
  EXPECT_EQ(known.at(id).unconfirmed, 0);
  EXPECT_FALSE(known.lost(again, 11, 8));
}

TEST_F(KnownObjectsTest, ALostBirthIsOwedUnlessAnotherArrived) {
  known.learn(3, 1, 0);
  const std::uint32_t id = known.find(3);
  const Sent first = pay(id, 1);
  EXPECT_TRUE(known.lost(first, 1, 5));
  EXPECT_EQ(known.due(id), kAllGroups);
  const Sent second = pay(id, 2);
  known.owe(id, kBody, 6);
  state.body.no_soft = true;
  const Sent third = pay(id, 3);
  EXPECT_EQ(third.groups, kAllGroups);
  known.arrived(second, 2);
  EXPECT_TRUE(known.lost(third, 3, 7));
  EXPECT_EQ(known.due(id), kBody) << "alive already, and all else is as the one that arrived said";
}

TEST_F(KnownObjectsTest, WhoWasNeverSentIsForgottenAtOnce) {
  known.learn(3, 1, 0);
  known.forget(0, 1);
  EXPECT_EQ(known.find(3), KnownObjects::kNobody);
  EXPECT_EQ(known.aliveCount(), 0u);
  EXPECT_EQ(known.at(0).life, Life::kFree);
  EXPECT_EQ(known.at(0).owed, 0);
  known.sweepOwing();
  EXPECT_TRUE(known.owing().empty());
  known.learn(4, 1, 2);
  EXPECT_EQ(known.find(4), 0u);
}

TEST_F(KnownObjectsTest, WhoIsForgottenAndLearntInOneTickIsOwedOnce) {
  known.learn(3, 1, 0);
  known.forget(0, 1);
  known.learn(4, 1, 1);
  EXPECT_EQ(known.owing(), Ids{0});
  EXPECT_TRUE(isOwing(0));
  pay(0, 1);
  EXPECT_TRUE(known.owing().empty());
}

TEST_F(KnownObjectsTest, ADeathIsOwedUntilItArrived) {
  const std::uint32_t id = alive(3);
  known.owe(id, kMotion, 4);
  known.forget(id, 5);
  EXPECT_EQ(known.find(3), KnownObjects::kNobody);
  EXPECT_EQ(known.aliveCount(), 0u);
  EXPECT_EQ(known.at(id).life, Life::kDying);
  EXPECT_TRUE(isOwing(id));
  EXPECT_EQ(known.due(id), kDeath);
  const Sent death = pay(id, 10);
  EXPECT_EQ(death.groups, kDeath);
  EXPECT_FALSE(isOwing(id));
  EXPECT_TRUE(known.lost(death, 10, 20));
  EXPECT_TRUE(isOwing(id));
  EXPECT_EQ(known.due(id), kDeath);
  known.arrived(pay(id, 11), 11);
  EXPECT_EQ(known.at(id).life, Life::kFree);
  EXPECT_FALSE(known.lost(death, 10, 30)) << "it is over";
}

TEST_F(KnownObjectsTest, NewsOfTheLivingAreNothingToTheDying) {
  const std::uint32_t id = alive(3);
  known.owe(id, kMotion, 4);
  const Sent moved = pay(id, 9);
  known.forget(id, 5);
  const Sent death = pay(id, 10);
  EXPECT_FALSE(known.lost(moved, 9, 6));
  known.arrived(moved, 9);
  EXPECT_EQ(known.at(id).life, Life::kDying);
  known.oweUnconfirmed(7);
  EXPECT_EQ(known.due(id), kDeath);
  known.arrived(death, 10);
  EXPECT_EQ(known.at(id).life, Life::kFree);
}

TEST_F(KnownObjectsTest, AnIdIsUsedAgainOnlyAfterItsDeathArrived) {
  const std::uint32_t first = alive(3);
  known.forget(first, 5);
  known.learn(4, 1, 5);
  EXPECT_NE(known.find(4), first);
  const Sent death = pay(first, 10);
  known.learn(5, 1, 5);
  EXPECT_NE(known.find(5), first);
  known.arrived(death, 10);
  const std::uint32_t birth = known.at(first).birth;
  known.learn(6, 1, 6);
  EXPECT_EQ(known.find(6), first);
  EXPECT_EQ(known.at(first).birth, birth + 1);
  EXPECT_EQ(KnownObjects::generationOf(known.at(first)), (birth + 1) % 3 + 1) << "never 0";
}

TEST_F(KnownObjectsTest, NewsOfThePredecessorAreNothingToTheNext) {
  const std::uint32_t id = alive(3);
  known.owe(id, kMotion, 4);
  const Sent moved = pay(id, 9);
  known.forget(id, 5);
  const Sent death = pay(id, 10);
  known.arrived(death, 10);
  known.learn(4, 1, 6);
  ASSERT_EQ(known.find(4), id);
  pay(id, 11);
  known.arrived(moved, 9);
  known.arrived(death, 10);
  EXPECT_FALSE(known.lost(moved, 9, 7));
  EXPECT_EQ(known.at(id).life, Life::kBorn);
  EXPECT_EQ(known.at(id).unconfirmed, kAllGroups);
}

TEST_F(KnownObjectsTest, TheLowestFreeIdIsGiven) {
  for (std::uint32_t slot = 0; slot < 5; ++slot) EXPECT_EQ(alive(100 + slot), slot);
  for (const std::uint32_t id : {3u, 1u, 4u}) {
    known.forget(id, 1);
    confirm(id);
  }
  for (const std::uint32_t id : {1u, 3u, 4u, 5u}) {
    known.learn(200 + id, 1, 2);
    EXPECT_EQ(known.find(200 + id), id);
  }
  EXPECT_EQ(known.idCount(), 6u);
}

TEST_F(KnownObjectsTest, VisitsTheBornAndTheAlive) {
  alive(10);
  const std::uint32_t dying = alive(11);
  known.learn(12, 1, 0);
  known.forget(dying, 1);
  Ids ids;
  known.forEachAlive([&](std::uint32_t id, const KnownObjects::Known&) { ids.push_back(id); });
  EXPECT_EQ(ids, (Ids{0, 2}));
  EXPECT_EQ(known.aliveCount(), 2u);
}

TEST_F(KnownObjectsTest, TheChecksumIsThatOfAllThatWasSent) {
  EXPECT_EQ(known.checksum(), 0u);
  state.order = 5;
  state.motion.position = {7, 8};
  known.learn(3, 1, 0);
  EXPECT_EQ(known.checksum(), 0u) << "nothing was sent yet";
  const auto sum = [&](std::uint32_t id, const ObjectState& s) {
    return lifeSum(id, KnownObjects::generationOf(known.at(id)), s.order) + motionSum(id, s.motion) +
           lookSum(id, s.look) + bodySum(id, s.body);
  };
  pay(0, 1);
  EXPECT_EQ(known.checksum(), sum(0, state));
  const std::uint32_t second = alive(4);
  EXPECT_EQ(known.checksum(), sum(0, state) + sum(second, state));
  const ObjectState before = state;
  state.motion.velocity = {1, 1};
  state.look.altitude = 3;
  known.owe(second, kMotion, 2);
  pay(second, 5);
  ObjectState moved = before;
  moved.motion = state.motion;
  EXPECT_EQ(known.checksum(), sum(0, before) + sum(second, moved)) << "the look was not sent";
  known.forget(0, 3);
  EXPECT_EQ(known.checksum(), sum(0, before) + sum(second, moved)) << "nor the death";
  pay(0, 6);
  EXPECT_EQ(known.checksum(), sum(second, moved));
}

}  // namespace
}  // namespace naiad
