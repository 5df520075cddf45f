#include <gtest/gtest.h>

#include <map>

#include "host/snapshot/KnownObjects.h"
#include "host/snapshot/SlotMap.h"
#include "shared/values/SplitMix64.h"

namespace naiad {
namespace {

using Life = KnownObjects::Life;
using Sent = KnownObjects::Sent;
using Ids = std::vector<std::uint32_t>;

class KnownObjectsTest : public testing::Test {
 protected:
  /// Adds an object that the client has confirmed; returns its id.
  std::uint32_t alive(std::uint32_t slot) {
    known.addObject(slot, 1, 0);
    const std::uint32_t id = known.find(slot);
    confirm(id);
    return id;
  }
  void confirm(std::uint32_t id) {
    ++number;
    known.confirmArrival(send(id, number), number);
  }
  Sent send(std::uint32_t id, std::uint32_t snapshot) {
    const Sent sent = known.markSent(id, snapshot, state, state.motion, 0);
    known.trimPending();
    return sent;
  }
  bool isPending(std::uint32_t id) const {
    return std::ranges::count(known.pendingIds(), id) == 1 && known.at(id).pending != 0;
  }

  KnownObjects known;
  ObjectState state;
  std::uint32_t number = 0;
};

TEST_F(KnownObjectsTest, BirthIsSentInFullUntilOneArrives) {
  known.addObject(70, 5, 33);
  const std::uint32_t id = known.find(70);
  EXPECT_EQ(id, 0u);
  EXPECT_EQ(known.at(id).life, Life::kBorn);
  EXPECT_EQ(known.at(id).slot, 70u);
  EXPECT_EQ(known.at(id).generation, 5u);
  EXPECT_EQ(known.at(id).pending_since, 33u);
  EXPECT_TRUE(isPending(id));
  EXPECT_EQ(known.groupsToSend(id), kAllGroups);
  const Sent first = send(id, 1);
  EXPECT_EQ(first.groups, kAllGroups);
  EXPECT_FALSE(isPending(id));
  EXPECT_TRUE(known.pendingIds().empty());
  known.addPending(id, kMotion, 34);
  EXPECT_TRUE(isPending(id));
  EXPECT_EQ(known.groupsToSend(id), kAllGroups) << "the client may not know it";
  const Sent second = send(id, 2);
  EXPECT_EQ(second.groups, kAllGroups);
  known.confirmArrival(second, 2);
  EXPECT_EQ(known.at(id).life, Life::kAlive);
  EXPECT_EQ(known.at(id).unconfirmed, 0);
  known.addPending(id, kMotion, 35);
  EXPECT_EQ(known.groupsToSend(id), kMotion);
  EXPECT_EQ(known.at(id).pending_since, 35u);
}

TEST_F(KnownObjectsTest, PendingGroupsAddUp) {
  const std::uint32_t id = alive(3);
  known.addPending(id, 0, 5);
  EXPECT_FALSE(isPending(id));
  known.addPending(id, kMotion, 5);
  known.addPending(id, kLook, 8);
  EXPECT_TRUE(isPending(id));
  EXPECT_EQ(known.groupsToSend(id), kMotion | kLook);
  EXPECT_EQ(known.at(id).pending_since, 5u) << "since the first of them";
}

TEST_F(KnownObjectsTest, OlderLossDoesNotRequeueResentGroups) {
  const std::uint32_t id = alive(3);
  known.addPending(id, kMotion | kLook, 5);
  const Sent first = send(id, 10);
  known.addPending(id, kMotion, 6);
  const Sent second = send(id, 11);
  EXPECT_TRUE(known.requeueLost(first, 10, 20));
  EXPECT_EQ(known.groupsToSend(id), kLook) << "the motion is in the later one";
  EXPECT_EQ(known.at(id).pending_since, 20u);
  send(id, 12);
  EXPECT_FALSE(known.requeueLost(first, 10, 21));
  EXPECT_TRUE(known.requeueLost(second, 11, 22));
  EXPECT_EQ(known.groupsToSend(id), kMotion);
}

TEST_F(KnownObjectsTest, AnOlderArrivalConfirmsNothingNewer) {
  const std::uint32_t id = alive(3);
  known.addPending(id, kMotion | kLook, 5);
  const Sent first = send(id, 10);
  known.addPending(id, kMotion, 6);
  state.motion.position.x += df::kFixedOne;
  send(id, 11);
  known.confirmArrival(first, 10);
  EXPECT_EQ(known.at(id).unconfirmed, kMotion);
  known.requeueUnconfirmed(30);
  EXPECT_EQ(known.groupsToSend(id), kMotion);
}

TEST_F(KnownObjectsTest, AnUnchangedGroupSentAgainIsConfirmedByEither) {
  const std::uint32_t id = alive(3);
  known.addPending(id, kMotion, 5);
  const Sent first = send(id, 10);
  known.addPending(id, kMotion, 6);
  const Sent again = send(id, 11);
  known.confirmArrival(first, 10);
  EXPECT_EQ(known.at(id).unconfirmed, 0);
  EXPECT_FALSE(known.requeueLost(again, 11, 8));
}

TEST_F(KnownObjectsTest, ALostBirthIsPendingAgainUnlessAnotherArrived) {
  known.addObject(3, 1, 0);
  const std::uint32_t id = known.find(3);
  const Sent first = send(id, 1);
  EXPECT_TRUE(known.requeueLost(first, 1, 5));
  EXPECT_EQ(known.groupsToSend(id), kAllGroups);
  const Sent second = send(id, 2);
  known.addPending(id, kBody, 6);
  state.body.no_soft = true;
  const Sent third = send(id, 3);
  EXPECT_EQ(third.groups, kAllGroups);
  known.confirmArrival(second, 2);
  EXPECT_TRUE(known.requeueLost(third, 3, 7));
  EXPECT_EQ(known.groupsToSend(id), kBody) << "alive already, and all else is as the one that arrived said";
}

TEST_F(KnownObjectsTest, UnsentObjectIsRemovedAtOnce) {
  known.addObject(3, 1, 0);
  known.removeObject(0, 1);
  EXPECT_EQ(known.find(3), KnownObjects::kNone);
  EXPECT_EQ(known.aliveCount(), 0u);
  EXPECT_EQ(known.at(0).life, Life::kFree);
  EXPECT_EQ(known.at(0).pending, 0);
  known.trimPending();
  EXPECT_TRUE(known.pendingIds().empty());
  known.addObject(4, 1, 2);
  EXPECT_EQ(known.find(4), 0u);
}

TEST_F(KnownObjectsTest, AnIdReusedWithinATickIsPendingOnce) {
  known.addObject(3, 1, 0);
  known.removeObject(0, 1);
  known.addObject(4, 1, 1);
  EXPECT_EQ(known.pendingIds(), Ids{0});
  EXPECT_TRUE(isPending(0));
  send(0, 1);
  EXPECT_TRUE(known.pendingIds().empty());
}

TEST_F(KnownObjectsTest, IdIsReusedOnlyAfterItsDeathArrived) {
  const std::uint32_t first = alive(3);
  known.removeObject(first, 5);
  known.addObject(4, 1, 5);
  EXPECT_NE(known.find(4), first);
  const Sent death = send(first, 10);
  known.addObject(5, 1, 5);
  EXPECT_NE(known.find(5), first);
  known.confirmArrival(death, 10);
  const std::uint32_t birth = known.at(first).birth;
  known.addObject(6, 1, 6);
  EXPECT_EQ(known.find(6), first);
  EXPECT_EQ(known.at(first).birth, birth + 1);
  EXPECT_EQ(KnownObjects::generationOf(known.at(first)), (birth + 1) % 3 + 1) << "never 0";
}

TEST_F(KnownObjectsTest, TheLowestFreeIdIsGiven) {
  for (std::uint32_t slot = 0; slot < 5; ++slot) EXPECT_EQ(alive(100 + slot), slot);
  for (const std::uint32_t id : {3u, 1u, 4u}) {
    known.removeObject(id, 1);
    confirm(id);
  }
  for (const std::uint32_t id : {1u, 3u, 4u, 5u}) {
    known.addObject(200 + id, 1, 2);
    EXPECT_EQ(known.find(200 + id), id);
  }
  EXPECT_EQ(known.idCount(), 6u);
}

TEST(SlotMap, AgreesWithTheStandardMap) {
  for (const std::uint32_t spread : {1u, 128u, 4096u}) {  // the hash ignores low bits
    SplitMix64 rng(spread);
    SlotMap map;
    EXPECT_EQ(map.find(0), SlotMap::kNone);
    std::map<std::uint32_t, std::uint32_t> plain;
    std::size_t most = 0;
    for (int i = 0; i < 60'000; ++i) {
      const auto slot = static_cast<std::uint32_t>(rng.below(256)) * spread;
      const bool adds = rng.below(100) < ((i / 5000) % 2 == 0 ? 70u : 30u);
      if (adds && plain.count(slot) == 0) {
        map.insert(slot, static_cast<std::uint32_t>(i));
        plain[slot] = static_cast<std::uint32_t>(i);
      } else if (!adds && plain.count(slot) == 1) {
        map.erase(slot);
        plain.erase(slot);
      }
      most = std::max(most, plain.size());
      if (i % 50 != 0) continue;
      for (std::uint32_t s = 0; s < 256; ++s) {
        const auto found = plain.find(s * spread);
        ASSERT_EQ(map.find(s * spread), found == plain.end() ? SlotMap::kNone : found->second)
            << "step " << i;
      }
    }
    EXPECT_GT(most, 150u);
  }
}

}  // namespace
}  // namespace naiad
