#include <gtest/gtest.h>

#include <string>

#include "LinkPair.h"
#include "shared/net/datagram/SealedLink.h"

namespace naiad::test {
namespace {

using namespace std::chrono_literals;

TEST(SealedLinkPath, NewestPacketSetsThePeerAddress) {
  LinkPair pair;
  const Path roamed = pathFrom("203.0.113.1");
  pair.settle(pair.home);
  const std::string late = pair.fromClient("late");
  EXPECT_EQ(pair.toServer(pair.fromClient("new"), roamed), "new");
  EXPECT_EQ(pair.server.path(), roamed);
  EXPECT_EQ(pair.toServer(late), "late");  // a packet from home, sent before the client moved
  EXPECT_EQ(pair.server.path(), roamed);
  EXPECT_EQ(pair.server.counters().path_changes, 2u);
}

TEST(SealedLinkPath, OlderEpochDoesNotChangeTheAddress) {
  LinkPair pair;
  pair.settle(pair.home);
  std::string late;
  for (int i = 0; i < 50; ++i) late = pair.fromClient("late");
  pair.startEpoch(1);
  pair.toClient(pair.fromServer("x"));
  pair.toServer(pair.fromClient("number 0 of epoch 1"));
  EXPECT_EQ(pair.toServer(late, pathFrom("203.0.113.1")), "late");
  EXPECT_EQ(pair.server.path(), pair.home);
}

TEST(SealedLinkPath, ReplaysAndForgeriesDoNotChangeTheAddress) {
  LinkPair pair;
  pair.settle(pair.home);
  const std::string packet = pair.fromClient("x");
  pair.toServer(packet);
  std::string forged = pair.fromClient("y");
  forged[15] = static_cast<char>(forged[15] ^ 1);
  EXPECT_EQ(pair.toServer(packet, pathFrom("203.0.113.1")), "<refused>");
  EXPECT_EQ(pair.toServer(forged, pathFrom("203.0.113.1")), "<refused>");
  EXPECT_EQ(pair.server.path(), pair.home);
}

TEST(SealedLinkPath, UnprovenAddressGetsAtMostThreeTimesItsBytes) {
  LinkPair pair;
  pair.settle(pair.home);
  for (const std::size_t size : {0u, 1u, 50u, 1000u}) {
    const Path victim = pathFrom("203.0.113.1", static_cast<std::uint16_t>(5000 + size));
    std::uint64_t in = 0, out = 0;
    for (int round = 0; round < 5; ++round) {
      const std::string packet = pair.fromClient(std::string(size, 'x'));
      in += packet.size();
      pair.toServer(packet, victim);
      for (int i = 0; i < 200; ++i) {
        const auto payload_budget = pair.server.payloadBudget();
        const auto sent = pair.seal(pair.server, std::string(i % 2 ? 300 : payload_budget.value_or(0), 'y'));
        if (i % 2 == 0) {
          EXPECT_EQ(sent.has_value(), payload_budget.has_value());
        }
        if (!sent) continue;
        EXPECT_EQ(sent->path, victim);
        out += sent->bytes.size();
      }
      ASSERT_LE(out, 3 * in);
      ASSERT_GT(out + 28, 3 * in);  // and the allowance is used up
    }
    EXPECT_FALSE(pair.server.isValidated(victim));
  }
  EXPECT_GT(pair.server.counters().over_budget, 0u);
}

TEST(SealedLinkPath, AnsweredChallengeLiftsTheLimit) {
  LinkPair pair;
  pair.toServer(pair.fromClient("hello"));
  EXPECT_FALSE(pair.server.isValidated(pair.home));
  EXPECT_TRUE(pair.server.needsToSend(pair.now));
  EXPECT_FALSE(pair.client.needsToSend(pair.now));
  EXPECT_EQ(pair.toClient(pair.fromServer("")), "");
  EXPECT_TRUE(pair.client.needsToSend(pair.now));
  EXPECT_EQ(pair.toServer(pair.fromClient("with the answer")), "with the answer");
  EXPECT_FALSE(pair.client.needsToSend(pair.now));
  EXPECT_TRUE(pair.server.isValidated(pair.home));
  EXPECT_FALSE(pair.server.needsToSend(pair.now));
  EXPECT_EQ(pair.server.payloadBudget(), pair.server.maxPayload());
  for (int i = 0; i < 100; ++i) EXPECT_TRUE(pair.seal(pair.server, std::string(1172, 'x')));
  EXPECT_EQ(pair.server.counters().paths_validated, 1u);
}

TEST(SealedLinkPath, LostChallengesAndAnswersAreRepeated) {
  LinkPair pair;
  pair.toServer(pair.fromClient(std::string(500, 'x')));
  pair.fromServer("lost");
  EXPECT_FALSE(pair.server.needsToSend(pair.now));
  pair.now += 249ms;
  EXPECT_FALSE(pair.server.needsToSend(pair.now));
  pair.now += 1ms;
  EXPECT_TRUE(pair.server.needsToSend(pair.now));
  pair.toClient(pair.fromServer(""));
  pair.fromClient("answer, lost");
  pair.now += 250ms;
  ASSERT_TRUE(pair.server.needsToSend(pair.now));
  pair.toClient(pair.fromServer(""));
  pair.toServer(pair.fromClient("answer"));
  EXPECT_TRUE(pair.server.isValidated(pair.home));
}

TEST(SealedLinkPath, AddressIsProvenOnlyByItsOwnChallenge) {
  LinkPair pair;
  const Path victim = pathFrom("203.0.113.1");
  pair.toServer(pair.fromClient(std::string(200, 'x')));
  const std::string move = pair.fromClient(std::string(200, 'x'));
  pair.toClient(pair.fromServer("challenge for home"));
  const std::string answer = pair.fromClient("");
  pair.toServer(move, victim);
  pair.fromServer("challenge that the victim gets");
  EXPECT_EQ(pair.toServer(answer, victim), "");
  EXPECT_FALSE(pair.server.isValidated(victim));
  EXPECT_EQ(pair.server.counters().wrong_answers, 1u);
}

TEST(SealedLinkPath, ReturnToAProvenAddressNeedsNoChallenge) {
  LinkPair pair;
  pair.settle(pair.home);
  const std::string copied = pair.fromClient("copied by someone on the way");
  pair.toServer(copied, pathFrom("203.0.113.1"));
  EXPECT_FALSE(pair.server.isValidated(pair.home));
  EXPECT_EQ(pair.toServer(copied), "<refused>");
  pair.toServer(pair.fromClient("next"));
  EXPECT_TRUE(pair.server.isValidated(pair.home));
  EXPECT_EQ(pair.server.payloadBudget(), pair.server.maxPayload());
}

TEST(SealedLinkPath, OtherLocalAddressIsAnotherPath) {
  LinkPair pair;
  pair.settle(pair.home);
  Path other = pair.home;
  other.local = *makeEndpoint("192.0.2.2", 9876);
  pair.toServer(pair.fromClient("x"), other);
  EXPECT_EQ(pair.seal(pair.server, "y")->path, other);  // from the address that received the packet
}

}  // namespace
}  // namespace naiad::test
