#include <gtest/gtest.h>
#include <openssl/evp.h>

#include <string>
#include <vector>

#include "LinkPair.h"
#include "shared/net/datagram/SealedLink.h"
#include "tests/support/AllocationCount.h"

namespace naiad::test {
namespace {

using namespace std::chrono_literals;
using namespace std::string_literals;
using SealedLinkTest = LinkFixture;

TEST_F(SealedLinkTest, CarriesPayloadsBothWays) {
  for (const AeadId cipher : kBothAeads) {
    LinkPair pair(cipher);
    EXPECT_EQ(pair.toServer(pair.fromClient("up")), "up");
    EXPECT_EQ(pair.toClient(pair.fromServer("down")), "down");
    EXPECT_EQ(pair.toServer(pair.fromClient("")), "");
    EXPECT_EQ(pair.server.counters().opened, 2u);
    EXPECT_EQ(pair.client.counters().opened, 1u);
  }
}

TEST_F(SealedLinkTest, ServerIsSilentBeforeTheClientsFirstAuthenticPacket) {
  EXPECT_FALSE(seal(server, "eager"));
  EXPECT_FALSE(server.needsToSend(now));
  EXPECT_FALSE(server.payloadBudget());
  std::string forged = fromClient("x");
  forged.back() = static_cast<char>(forged.back() ^ 1);
  EXPECT_EQ(toServer(forged), "<refused>");
  EXPECT_FALSE(seal(server, "eager"));
  EXPECT_EQ(server.counters().no_path, 2u);
  EXPECT_FALSE(server.path());
  toServer(fromClient("x"));
  EXPECT_TRUE(seal(server, "now"));
}

TEST_F(SealedLinkTest, WithoutKeysNothingIsSealedOrOpened) {
  SealedLink keyless({.role = SealedLink::Role::kClient, .id = kSession, .random = {}, .limits = {}});
  keyless.setServerPath(pathFrom("192.0.2.1"));
  EXPECT_FALSE(keyless.seal("x", {}));
  EXPECT_EQ(keyless.counters().no_key, 1u);
  EXPECT_FALSE(keyless.epoch());
  toServer(fromClient("x"));
  EXPECT_FALSE(keyless.open(server_path, fromServer("x"), {}));
  EXPECT_EQ(keyless.counters().unknown_epoch, 1u);
}

TEST_F(SealedLinkTest, LargestPayloadsAlwaysFitExactly) {
  EXPECT_EQ(client.maxPayload(), 1164u);
  EXPECT_EQ(server.maxPayload(), 1172u);
  toServer(fromClient(std::string(1164, 'x')));
  const std::string down = fromServer(std::string(1172, 'x'));  // with a challenge
  EXPECT_EQ(down.size(), 1200u);
  EXPECT_EQ(toClient(down).size(), 1172u);
  const std::string up = fromClient(std::string(1164, 'x'));  // with an answer
  EXPECT_EQ(up.size(), 1200u);
  EXPECT_EQ(toServer(up).size(), 1164u);
  EXPECT_EQ(fromServer("").size(), smallestSealedPacket(SealDirection::kServerToClient));
  EXPECT_EQ(fromClient("").size(), smallestSealedPacket(SealDirection::kClientToServer));
}

TEST_F(SealedLinkTest, EveryRefusalHasItsCounter) {
  const std::string old = fromClient("old");
  for (int i = 0; i < 1100; ++i) fromClient("lost");
  const std::string packet = fromClient("x");
  ASSERT_EQ(toServer(packet), "x");
  const auto changed = [&](std::size_t at, int bits) {
    std::string other = packet;
    other[at] = static_cast<char>(other[at] ^ bits);
    return other;
  };
  EXPECT_EQ(toServer(packet.substr(0, 27)), "<refused>");
  EXPECT_EQ(toServer(packet + std::string(1200, 'x')), "<refused>");
  EXPECT_EQ(toServer(changed(0, 0x30)), "<refused>");  // the kind of packets that the server sends
  EXPECT_EQ(toServer(changed(3, 1)), "<refused>");
  EXPECT_EQ(toServer(changed(0, 1)), "<refused>");
  EXPECT_EQ(toServer(packet), "<refused>");
  EXPECT_EQ(toServer(old), "<refused>");
  EXPECT_EQ(toServer(changed(10, 8)), "<refused>");
  const SealedLinkCounters& counted = server.counters();
  EXPECT_EQ(counted.too_short, 1u);
  EXPECT_EQ(counted.too_long, 1u);
  EXPECT_EQ(counted.bad_kind, 1u);
  EXPECT_EQ(counted.wrong_id, 1u);
  EXPECT_EQ(counted.unknown_epoch, 1u);
  EXPECT_EQ(counted.replayed, 1u);
  EXPECT_EQ(counted.too_old, 1u);
  EXPECT_EQ(counted.forged, 1u);
  EXPECT_EQ(counted.opened, 1u);
}

TEST_F(SealedLinkTest, AuthenticMalformedPacketsAreCountedAndIgnored) {
  toServer(fromClient("x"));
  Sealer sealer(keys(0).client);
  const auto sealed = [&](std::string_view text) {
    std::string packet(kMaxDatagram, '\0');
    const std::size_t prefix = writeSealedPrefix(SealDirection::kClientToServer, 0, kSession, packet.data());
    packet.replace(prefix + 2, text.size(), text);
    packet.resize(sealer.seal(packet.data(), prefix, text.size()));
    return packet;
  };
  sealed("\0");  // uses up number 0
  const Path elsewhere = pathFrom("203.0.113.1");
  // A challenge to a server, reserved flags, a truncated answer.
  for (const std::string& text :
       {'\x01' + "12345678"s, "\x04"s, "\x80"s, '\x03' + "1234567812345678"s, '\x02' + "1234567"s}) {
    EXPECT_EQ(toServer(sealed(text), elsewhere), "<refused>");
  }
  EXPECT_EQ(server.counters().malformed, 5u);
  EXPECT_EQ(server.path(), home);
  EXPECT_EQ(toServer(sealed('\x02' + "12345678and so on"s), elsewhere), "and so on");
  EXPECT_EQ(server.counters().wrong_answers, 1u);
}

TEST_F(SealedLinkTest, PacketsCostNoAllocation) {
  if (!canCountAllocations()) GTEST_SKIP() << "sanitizers bring their own allocator";
  for (const AeadId cipher : kBothAeads) {
    LinkPair pair(cipher);
    pair.settle(pair.home);
    const std::string payload(100, 'x');
    bool well = true;
    const auto one = [&] {
      const auto up = pair.client.seal(payload, pair.now);
      char forged[kMaxDatagram];
      const std::size_t size = up->packet.copy(forged, sizeof forged);
      forged[size - 1] = static_cast<char>(forged[size - 1] ^ 1);
      well = well && !pair.server.open(pair.home, {forged, size}, pair.now);
      well = well && pair.server.open(pair.home, up->packet, pair.now);
      const auto down = pair.server.seal(payload, pair.now);
      well = well && down && pair.client.open(pair.server_path, down->packet, pair.now);
    };
    one();
    const std::uint64_t before = allocationsSoFar();
    for (int i = 0; i < 1000; ++i) one();
    const std::uint64_t after = allocationsSoFar();
    EXPECT_EQ(after, before);
    EXPECT_TRUE(well);
    EVP_CIPHER_CTX_free(EVP_CIPHER_CTX_new());
    EXPECT_GT(allocationsSoFar(), after);  // checks that allocations are counted
  }
}

using SealedLinkPath = LinkFixture;

TEST_F(SealedLinkPath, NewestPacketSetsThePeerAddress) {
  const Path roamed = pathFrom("203.0.113.1");
  settle(home);
  const std::string late = fromClient("late");
  EXPECT_EQ(toServer(fromClient("new"), roamed), "new");
  EXPECT_EQ(server.path(), roamed);
  EXPECT_EQ(toServer(late), "late");  // a packet from home, sent before the client moved
  EXPECT_EQ(server.path(), roamed);
  EXPECT_EQ(server.counters().path_changes, 2u);
}

TEST_F(SealedLinkPath, OlderEpochDoesNotChangeTheAddress) {
  settle(home);
  std::string late;
  for (int i = 0; i < 50; ++i) late = fromClient("late");
  startEpoch(1);
  toClient(fromServer("x"));
  toServer(fromClient("number 0 of epoch 1"));
  EXPECT_EQ(toServer(late, pathFrom("203.0.113.1")), "late");
  EXPECT_EQ(server.path(), home);
}

TEST_F(SealedLinkPath, ReplaysAndForgeriesDoNotChangeTheAddress) {
  settle(home);
  const std::string packet = fromClient("x");
  toServer(packet);
  std::string forged = fromClient("y");
  forged[15] = static_cast<char>(forged[15] ^ 1);
  EXPECT_EQ(toServer(packet, pathFrom("203.0.113.1")), "<refused>");
  EXPECT_EQ(toServer(forged, pathFrom("203.0.113.1")), "<refused>");
  EXPECT_EQ(server.path(), home);
}

TEST_F(SealedLinkPath, UnprovenAddressGetsAtMostThreeTimesItsBytes) {
  settle(home);
  for (const std::size_t size : {0u, 1u, 50u, 1000u}) {
    const Path victim = pathFrom("203.0.113.1", static_cast<std::uint16_t>(5000 + size));
    std::uint64_t in = 0, out = 0;
    for (int round = 0; round < 5; ++round) {
      const std::string packet = fromClient(std::string(size, 'x'));
      in += packet.size();
      toServer(packet, victim);
      for (int i = 0; i < 200; ++i) {
        const auto payload_budget = server.payloadBudget();
        const auto sent = seal(server, std::string(i % 2 ? 300 : payload_budget.value_or(0), 'y'));
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
    EXPECT_FALSE(server.isValidated(victim));
  }
  EXPECT_GT(server.counters().over_budget, 0u);
}

TEST_F(SealedLinkPath, AnsweredChallengeLiftsTheLimit) {
  toServer(fromClient("hello"));
  EXPECT_FALSE(server.isValidated(home));
  EXPECT_TRUE(server.needsToSend(now));
  EXPECT_FALSE(client.needsToSend(now));
  EXPECT_EQ(toClient(fromServer("")), "");
  EXPECT_TRUE(client.needsToSend(now));
  EXPECT_EQ(toServer(fromClient("with the answer")), "with the answer");
  EXPECT_FALSE(client.needsToSend(now));
  EXPECT_TRUE(server.isValidated(home));
  EXPECT_FALSE(server.needsToSend(now));
  EXPECT_EQ(server.payloadBudget(), server.maxPayload());
  for (int i = 0; i < 100; ++i) EXPECT_TRUE(seal(server, std::string(1172, 'x')));
  EXPECT_EQ(server.counters().paths_validated, 1u);
}

TEST_F(SealedLinkPath, LostChallengesAndAnswersAreRepeated) {
  toServer(fromClient(std::string(500, 'x')));
  fromServer("lost");
  EXPECT_FALSE(server.needsToSend(now));
  now += 249ms;
  EXPECT_FALSE(server.needsToSend(now));
  now += 1ms;
  EXPECT_TRUE(server.needsToSend(now));
  toClient(fromServer(""));
  fromClient("answer, lost");
  now += 250ms;
  ASSERT_TRUE(server.needsToSend(now));
  toClient(fromServer(""));
  toServer(fromClient("answer"));
  EXPECT_TRUE(server.isValidated(home));
}

TEST_F(SealedLinkPath, AddressIsProvenOnlyByItsOwnChallenge) {
  const Path victim = pathFrom("203.0.113.1");
  toServer(fromClient(std::string(200, 'x')));
  const std::string move = fromClient(std::string(200, 'x'));
  toClient(fromServer("challenge for home"));
  const std::string answer = fromClient("");
  toServer(move, victim);
  fromServer("challenge that the victim gets");
  EXPECT_EQ(toServer(answer, victim), "");
  EXPECT_FALSE(server.isValidated(victim));
  EXPECT_EQ(server.counters().wrong_answers, 1u);
}

TEST_F(SealedLinkPath, ReturnToAProvenAddressNeedsNoChallenge) {
  settle(home);
  const std::string copied = fromClient("copied by someone on the way");
  toServer(copied, pathFrom("203.0.113.1"));
  EXPECT_FALSE(server.isValidated(home));
  EXPECT_EQ(toServer(copied), "<refused>");
  toServer(fromClient("next"));
  EXPECT_TRUE(server.isValidated(home));
  EXPECT_EQ(server.payloadBudget(), server.maxPayload());
}

TEST_F(SealedLinkPath, OtherLocalAddressIsAnotherPath) {
  settle(home);
  Path other = home;
  other.local = *makeEndpoint("192.0.2.2", 9876);
  toServer(fromClient("x"), other);
  EXPECT_EQ(seal(server, "y")->path, other);  // from the address that received the packet
}

/// The server has validated the client's address.
struct SealedLinkEpoch : LinkFixture {
  SealedLinkEpoch() { settle(home); }
};

TEST_F(SealedLinkEpoch, PacketsInFlightSurviveAnEpochChange) {
  std::vector<std::string> up, down;
  for (int i = 0; i < 20; ++i) {
    if (i == 10) startEpoch(1);
    up.push_back(fromClient("up" + std::to_string(i)));
    down.push_back(fromServer("down" + std::to_string(i)));
  }
  EXPECT_EQ(down[9][0] & 15, 0);
  EXPECT_EQ(down[10][0] & 15, 1);
  now += 9999ms;
  for (int i = 19; i >= 0; --i) {
    EXPECT_EQ(toServer(up[i]), "up" + std::to_string(i));
    EXPECT_EQ(toClient(down[i]), "down" + std::to_string(i));
  }
}

TEST_F(SealedLinkEpoch, PreviousEpochEndsAfterTenSeconds) {
  const std::string up = fromClient("up"), down = fromServer("down");
  startEpoch(1);
  now += 10s;
  EXPECT_EQ(toServer(up), "<refused>");
  EXPECT_EQ(toClient(down), "<refused>");
  EXPECT_EQ(server.counters().unknown_epoch, 1u);
  EXPECT_EQ(toServer(fromClient("new")), "new");
}

TEST_F(SealedLinkEpoch, ClientUsesNewKeysOnceTheServerHasThem) {
  client.startEpoch(1, keys(1), now);
  EXPECT_EQ(toServer(fromClient("the server has epoch 0 only")), "the server has epoch 0 only");
  server.startEpoch(1, keys(1), now);
  const std::string down = fromServer("x");
  EXPECT_EQ(down[0] & 15, 1);
  EXPECT_EQ(fromClient("x")[0] & 15, 0);
  toClient(down);
  EXPECT_EQ(fromClient("x")[0] & 15, 1);
}

TEST_F(SealedLinkEpoch, ClientWithoutRepliesSwitchesWhenOldKeysExpire) {
  client.startEpoch(1, keys(1), now);
  now += 100ms;
  server.startEpoch(1, keys(1), now);  // the client receives nothing
  for (int i = 0; i < 150; ++i, now += 100ms) {
    ASSERT_EQ(toServer(fromClient("x")), "x") << i;
    EXPECT_EQ(client.seal("y", now)->packet[0] & 15, i < 99 ? 0 : 1);
  }
}

TEST_F(SealedLinkEpoch, ManyEpochsFollowEachOther) {
  for (Epoch epoch = 1; epoch < 100; epoch += 1 + epoch % 15) {
    const std::string before = fromClient("before");
    startEpoch(epoch);
    EXPECT_EQ(toClient(fromServer("down")), "down");
    EXPECT_EQ(toServer(fromClient("up")), "up");
    EXPECT_EQ(toServer(before), "before");
    EXPECT_EQ(server.epoch(), epoch);
    now += 3s;
  }
  EXPECT_EQ(server.counters().path_changes, 1u);
}

TEST_F(SealedLinkEpoch, EpochsAdvanceOnlyByALimitedStep) {
  EXPECT_TRUE(client.startEpoch(15, keys(15), now));
  for (const Epoch epoch : {0u, 14u, 15u, 31u, 0xffffffffu})
    EXPECT_FALSE(client.startEpoch(epoch, keys(epoch), now)) << epoch;
  EXPECT_EQ(client.epoch(), 15u);
  EXPECT_TRUE(client.startEpoch(30, keys(30), now));
}

TEST_F(SealedLinkEpoch, KeyLimitIsReportedAndEnforced) {
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
TEST_F(SealedLinkEpoch, ClientWatchesTheServersKeyLimit) {
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
