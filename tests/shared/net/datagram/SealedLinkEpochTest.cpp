#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "LinkPair.h"
#include "shared/net/datagram/SealedLink.h"

namespace naiad::test {
namespace {

using namespace std::chrono_literals;

TEST(SealedLinkEpoch, PacketsInFlightSurviveAnEpochChange) {
  LinkPair pair;
  pair.settle(pair.home);
  std::vector<std::string> up, down;
  for (int i = 0; i < 20; ++i) {
    if (i == 10) pair.startEpoch(1);
    up.push_back(pair.fromClient("up" + std::to_string(i)));
    down.push_back(pair.fromServer("down" + std::to_string(i)));
  }
  EXPECT_EQ(down[9][0] & 15, 0);
  EXPECT_EQ(down[10][0] & 15, 1);
  pair.now += 9999ms;
  for (int i = 19; i >= 0; --i) {
    EXPECT_EQ(pair.toServer(up[i]), "up" + std::to_string(i));
    EXPECT_EQ(pair.toClient(down[i]), "down" + std::to_string(i));
  }
}

TEST(SealedLinkEpoch, PreviousEpochEndsAfterTenSeconds) {
  LinkPair pair;
  pair.settle(pair.home);
  const std::string up = pair.fromClient("up"), down = pair.fromServer("down");
  pair.startEpoch(1);
  pair.now += 10s;
  EXPECT_EQ(pair.toServer(up), "<refused>");
  EXPECT_EQ(pair.toClient(down), "<refused>");
  EXPECT_EQ(pair.server.counters().unknown_epoch, 1u);
  EXPECT_EQ(pair.toServer(pair.fromClient("new")), "new");
}

TEST(SealedLinkEpoch, ClientUsesNewKeysOnceTheServerHasThem) {
  LinkPair pair;
  pair.settle(pair.home);
  pair.client.startEpoch(1, pair.keys(1), pair.now);
  EXPECT_EQ(pair.toServer(pair.fromClient("the server has epoch 0 only")), "the server has epoch 0 only");
  pair.server.startEpoch(1, pair.keys(1), pair.now);
  const std::string down = pair.fromServer("x");
  EXPECT_EQ(down[0] & 15, 1);
  EXPECT_EQ(pair.fromClient("x")[0] & 15, 0);
  pair.toClient(down);
  EXPECT_EQ(pair.fromClient("x")[0] & 15, 1);
}

TEST(SealedLinkEpoch, ClientWithoutRepliesSwitchesWhenOldKeysExpire) {
  LinkPair pair;
  pair.settle(pair.home);
  pair.client.startEpoch(1, pair.keys(1), pair.now);
  pair.now += 100ms;
  pair.server.startEpoch(1, pair.keys(1), pair.now);  // the client receives nothing
  for (int i = 0; i < 150; ++i, pair.now += 100ms) {
    ASSERT_EQ(pair.toServer(pair.fromClient("x")), "x") << i;
    EXPECT_EQ(pair.client.seal("y", pair.now)->packet[0] & 15, i < 99 ? 0 : 1);
  }
}

TEST(SealedLinkEpoch, ManyEpochsFollowEachOther) {
  LinkPair pair;
  pair.settle(pair.home);
  for (Epoch epoch = 1; epoch < 100; epoch += 1 + epoch % 15) {
    const std::string before = pair.fromClient("before");
    pair.startEpoch(epoch);
    EXPECT_EQ(pair.toClient(pair.fromServer("down")), "down");
    EXPECT_EQ(pair.toServer(pair.fromClient("up")), "up");
    EXPECT_EQ(pair.toServer(before), "before");
    EXPECT_EQ(pair.server.epoch(), epoch);
    pair.now += 3s;
  }
  EXPECT_EQ(pair.server.counters().path_changes, 1u);
}

TEST(SealedLinkEpoch, EpochsAdvanceOnlyByALimitedStep) {
  LinkPair pair;
  EXPECT_TRUE(pair.client.startEpoch(15, pair.keys(15), pair.now));
  for (const Epoch epoch : {0u, 14u, 15u, 31u, 0xffffffffu})
    EXPECT_FALSE(pair.client.startEpoch(epoch, pair.keys(epoch), pair.now)) << epoch;
  EXPECT_EQ(pair.client.epoch(), 15u);
  EXPECT_TRUE(pair.client.startEpoch(30, pair.keys(30), pair.now));
}

TEST(SealedLinkEpoch, KeyLimitIsReportedAndEnforced) {
  EXPECT_EQ(SealLimits{}.new_epoch_after, 1u << 23);
  LinkPair pair(AeadId::kAes128Gcm, {.new_epoch_after = 5, .max = 8});
  for (int i = 0; i < 8; ++i) {
    EXPECT_EQ(pair.client.needsNewEpoch(), i >= 5);
    EXPECT_TRUE(pair.seal(pair.client, "x"));
  }
  EXPECT_FALSE(pair.seal(pair.client, "x"));
  EXPECT_FALSE(pair.client.payloadBudget());
  EXPECT_EQ(pair.client.counters().no_key, 1u);
  pair.startEpoch(1);
  EXPECT_FALSE(pair.client.needsNewEpoch());
  EXPECT_EQ(pair.toServer(pair.fromClient("on we go")), "on we go");
}

// Only the client can open a new stream for new keys, so it also watches the limit of the server's key.
TEST(SealedLinkEpoch, ClientWatchesTheServersKeyLimit) {
  LinkPair pair(AeadId::kAes128Gcm, {.new_epoch_after = 5, .max = 100});
  pair.settle(pair.home);  // otherwise the server may send only three times the bytes received
  for (int i = 1; i < 5; ++i) {
    EXPECT_FALSE(pair.client.needsNewEpoch()) << i;
    EXPECT_EQ(pair.toClient(pair.fromServer("news")), "news");
  }
  EXPECT_TRUE(pair.client.needsNewEpoch());
  pair.startEpoch(1);
  EXPECT_FALSE(pair.client.needsNewEpoch());
}

}  // namespace
}  // namespace naiad::test
