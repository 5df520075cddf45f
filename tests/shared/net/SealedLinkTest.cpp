#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "AllocationCount.h"
#include "LinkPair.h"
#include "SealedLink.h"

namespace naiad::test {
namespace {

using namespace std::chrono_literals;
using namespace std::string_literals;

TEST(SealedLink, CarriesPayloadsBothWays) {
  for (const AeadId aead : kBothAeads) {
    LinkPair pair(aead);
    EXPECT_EQ(pair.toServer(pair.fromClient("up")), "up");
    EXPECT_EQ(pair.toClient(pair.fromServer("down")), "down");
    EXPECT_EQ(pair.toServer(pair.fromClient("")), "");
    EXPECT_EQ(pair.server.counters().opened, 2u);
    EXPECT_EQ(pair.client.counters().opened, 1u);
  }
}

TEST(SealedLink, ServerIsSilentBeforeTheClientsFirstAuthenticPacket) {
  LinkPair pair;
  EXPECT_FALSE(pair.seal(pair.server, "eager"));
  EXPECT_FALSE(pair.server.wantsToSend(pair.now));
  EXPECT_FALSE(pair.server.room());
  std::string forged = pair.fromClient("x");
  forged.back() = static_cast<char>(forged.back() ^ 1);
  EXPECT_EQ(pair.toServer(forged), "<refused>");
  EXPECT_FALSE(pair.seal(pair.server, "eager"));
  EXPECT_EQ(pair.server.counters().no_path, 2u);
  EXPECT_FALSE(pair.server.path());
  pair.toServer(pair.fromClient("x"));
  EXPECT_TRUE(pair.seal(pair.server, "now"));
}

TEST(SealedLink, WithoutKeysNothingIsSealedOrOpened) {
  SealedLink client({.role = SealedLink::Role::kClient, .id = kSession, .random = {}, .limits = {}});
  client.setServerPath(pathFrom("192.0.2.1"));
  EXPECT_FALSE(client.seal("x", {}));
  EXPECT_EQ(client.counters().no_key, 1u);
  EXPECT_FALSE(client.epoch());
  LinkPair pair;
  pair.toServer(pair.fromClient("x"));
  EXPECT_FALSE(client.open(pair.server_path, pair.fromServer("x"), {}));
  EXPECT_EQ(client.counters().unknown_epoch, 1u);
}

TEST(SealedLink, LargestPayloadsFitExactlyAndAlways) {
  LinkPair pair;
  EXPECT_EQ(pair.client.maxPayload(), 1164u);
  EXPECT_EQ(pair.server.maxPayload(), 1172u);
  pair.toServer(pair.fromClient(std::string(1164, 'x')));
  const std::string down = pair.fromServer(std::string(1172, 'x'));  // with a challenge
  EXPECT_EQ(down.size(), 1200u);
  EXPECT_EQ(pair.toClient(down).size(), 1172u);
  const std::string up = pair.fromClient(std::string(1164, 'x'));  // with an answer
  EXPECT_EQ(up.size(), 1200u);
  EXPECT_EQ(pair.toServer(up).size(), 1164u);
  EXPECT_EQ(pair.fromServer("").size(), smallestSealedPacket(Direction::kServerToClient));
  EXPECT_EQ(pair.fromClient("").size(), smallestSealedPacket(Direction::kClientToServer));
}

TEST(SealedLink, EveryRefusalHasItsCounter) {
  LinkPair pair;
  const std::string old = pair.fromClient("old");
  for (int i = 0; i < 1100; ++i) pair.fromClient("lost");
  const std::string packet = pair.fromClient("x");
  ASSERT_EQ(pair.toServer(packet), "x");
  const auto changed = [&](std::size_t at, int bits) {
    std::string other = packet;
    other[at] = static_cast<char>(other[at] ^ bits);
    return other;
  };
  EXPECT_EQ(pair.toServer(packet.substr(0, 27)), "<refused>");
  EXPECT_EQ(pair.toServer(packet + std::string(1200, 'x')), "<refused>");
  EXPECT_EQ(pair.toServer(changed(0, 0x30)), "<refused>");  // the server's own kind
  EXPECT_EQ(pair.toServer(changed(3, 1)), "<refused>");
  EXPECT_EQ(pair.toServer(changed(0, 1)), "<refused>");
  EXPECT_EQ(pair.toServer(packet), "<refused>");
  EXPECT_EQ(pair.toServer(old), "<refused>");
  EXPECT_EQ(pair.toServer(changed(10, 8)), "<refused>");
  const SealedLinkCounters& counted = pair.server.counters();
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

TEST(SealedLink, ThrownBackPacketsAreRefused) {
  LinkPair pair;
  const std::string up = pair.fromClient("up");
  pair.toServer(up);
  const std::string down = pair.fromServer("a packet that is long enough");
  EXPECT_EQ(pair.toClient(up), "<refused>");
  EXPECT_EQ(pair.toServer(down), "<refused>");
  EXPECT_EQ(pair.client.counters().bad_kind, 1u);
  EXPECT_EQ(pair.server.counters().bad_kind, 1u);
}

TEST(SealedLink, AuthenticNonsenseIsCountedAndMovesNothing) {
  LinkPair pair;
  pair.toServer(pair.fromClient("x"));
  Sealer sealer(pair.keys(0).client);
  const auto seal = [&](std::string_view text) {
    std::string packet(kMaxDatagram, '\0');
    const std::size_t prefix = writeSealedPrefix(Direction::kClientToServer, 0, kSession, packet.data());
    packet.replace(prefix + 2, text.size(), text);
    packet.resize(sealer.seal(packet.data(), prefix, text.size()));
    return packet;
  };
  seal("\0");  // number 0 was used
  const Path elsewhere = pathFrom("203.0.113.1");
  // A challenge to a server, reserved flags, an answer cut short.
  for (const std::string& text : {"\x01"
                                  "12345678"s,
                                  "\x04"s, "\x80"s,
                                  "\x03"
                                  "1234567812345678"s,
                                  "\x02"
                                  "1234567"s}) {
    EXPECT_EQ(pair.toServer(seal(text), elsewhere), "<refused>");
  }
  EXPECT_EQ(pair.server.counters().malformed, 5u);
  EXPECT_EQ(pair.server.path(), pair.home);
  EXPECT_EQ(pair.toServer(seal("\x02"
                               "12345678and so on"s),
                          elsewhere),
            "and so on");
  EXPECT_EQ(pair.server.counters().wrong_answers, 1u);
}

// Epochs.

TEST(SealedLink, PacketsInFlightSurviveAnEpochChange) {
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

TEST(SealedLink, PreviousEpochEndsAfterTenSeconds) {
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

TEST(SealedLink, ClientUsesNewKeysOnceTheServerHasThem) {
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

TEST(SealedLink, ClientThatHearsNothingUsesNewKeysWhenTheOldOnesExpire) {
  LinkPair pair;
  pair.settle(pair.home);
  pair.client.startEpoch(1, pair.keys(1), pair.now);
  pair.now += 100ms;
  pair.server.startEpoch(1, pair.keys(1), pair.now);  // nothing gets through to the client
  for (int i = 0; i < 150; ++i, pair.now += 100ms) {
    ASSERT_EQ(pair.toServer(pair.fromClient("x")), "x") << i;
    EXPECT_EQ(pair.client.seal("y", pair.now)->packet[0] & 15, i < 99 ? 0 : 1);
  }
}

TEST(SealedLink, ManyEpochsFollowEachOther) {
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

TEST(SealedLink, LimitsOfTheKeyAreShownAndHeld) {
  LinkPair pair(AeadId::kAes128Gcm, {.new_epoch_after = 5, .most = 8});
  for (int i = 0; i < 8; ++i) {
    EXPECT_EQ(pair.client.wantsNewEpoch(), i >= 5);
    EXPECT_TRUE(pair.seal(pair.client, "x"));
  }
  EXPECT_FALSE(pair.seal(pair.client, "x"));
  EXPECT_FALSE(pair.client.room());
  EXPECT_EQ(pair.client.counters().no_key, 1u);
  pair.startEpoch(1);
  EXPECT_FALSE(pair.client.wantsNewEpoch());
  EXPECT_EQ(pair.toServer(pair.fromClient("on we go")), "on we go");
}

// Addresses.

TEST(SealedLink, NewestPacketNamesTheAddress) {
  LinkPair pair;
  const Path roamed = pathFrom("203.0.113.1");
  pair.settle(pair.home);
  const std::string late = pair.fromClient("late");
  EXPECT_EQ(pair.toServer(pair.fromClient("new"), roamed), "new");
  EXPECT_EQ(pair.server.path(), roamed);
  EXPECT_EQ(pair.toServer(late), "late");  // from home, but older
  EXPECT_EQ(pair.server.path(), roamed);
  EXPECT_EQ(pair.server.counters().path_changes, 2u);
}

TEST(SealedLink, OlderEpochNamesNoAddress) {
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

TEST(SealedLink, ReplaysAndForgeriesNameNoAddress) {
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

TEST(SealedLink, UnprovenAddressGetsThreeTimesItsBytes) {
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
        const auto room = pair.server.room();
        const auto sent = pair.seal(pair.server, std::string(i % 2 ? 300 : room.value_or(0), 'y'));
        if (i % 2 == 0) {
          EXPECT_EQ(sent.has_value(), room.has_value());
        }
        if (!sent) continue;
        EXPECT_EQ(sent->path, victim);
        out += sent->bytes.size();
      }
      ASSERT_LE(out, 3 * in);
      ASSERT_GT(out + 28, 3 * in);  // and it does use it
    }
    EXPECT_FALSE(pair.server.isValidated(victim));
  }
  EXPECT_GT(pair.server.counters().over_budget, 0u);
}

TEST(SealedLink, AnsweredChallengeLiftsTheLimit) {
  LinkPair pair;
  pair.toServer(pair.fromClient("hello"));
  EXPECT_FALSE(pair.server.isValidated(pair.home));
  EXPECT_TRUE(pair.server.wantsToSend(pair.now));
  EXPECT_FALSE(pair.client.wantsToSend(pair.now));
  EXPECT_EQ(pair.toClient(pair.fromServer("")), "");
  EXPECT_TRUE(pair.client.wantsToSend(pair.now));
  EXPECT_EQ(pair.toServer(pair.fromClient("with the answer")), "with the answer");
  EXPECT_FALSE(pair.client.wantsToSend(pair.now));
  EXPECT_TRUE(pair.server.isValidated(pair.home));
  EXPECT_FALSE(pair.server.wantsToSend(pair.now));
  EXPECT_EQ(pair.server.room(), pair.server.maxPayload());
  for (int i = 0; i < 100; ++i) EXPECT_TRUE(pair.seal(pair.server, std::string(1172, 'x')));
  EXPECT_EQ(pair.server.counters().paths_validated, 1u);
}

TEST(SealedLink, LostChallengesAndAnswersAreRepeated) {
  LinkPair pair;
  pair.toServer(pair.fromClient(std::string(500, 'x')));
  pair.fromServer("lost");
  EXPECT_FALSE(pair.server.wantsToSend(pair.now));
  pair.now += 249ms;
  EXPECT_FALSE(pair.server.wantsToSend(pair.now));
  pair.now += 1ms;
  EXPECT_TRUE(pair.server.wantsToSend(pair.now));
  pair.toClient(pair.fromServer(""));
  pair.fromClient("answer, lost");
  pair.now += 250ms;
  ASSERT_TRUE(pair.server.wantsToSend(pair.now));
  pair.toClient(pair.fromServer(""));
  pair.toServer(pair.fromClient("answer"));
  EXPECT_TRUE(pair.server.isValidated(pair.home));
}

TEST(SealedLink, AnswerToAnotherAddressProvesNothing) {
  LinkPair pair;
  const Path victim = pathFrom("203.0.113.1");
  pair.toServer(pair.fromClient(std::string(200, 'x')));
  pair.toClient(pair.fromServer("challenge for home"));
  const std::string answer = pair.fromClient("");
  EXPECT_EQ(pair.toServer(answer, victim), "");  // the answer itself moves the session there
  EXPECT_EQ(pair.server.path(), victim);
  EXPECT_FALSE(pair.server.isValidated(victim));
  EXPECT_EQ(pair.server.counters().wrong_answers, 1u);
}

TEST(SealedLink, ComingBackToTheProvenAddressCostsNothing) {
  LinkPair pair;
  pair.settle(pair.home);
  const std::string copied = pair.fromClient("copied by someone on the way");
  pair.toServer(copied, pathFrom("203.0.113.1"));
  EXPECT_FALSE(pair.server.isValidated(pair.home));
  EXPECT_EQ(pair.toServer(copied), "<refused>");
  pair.toServer(pair.fromClient("next"));
  EXPECT_TRUE(pair.server.isValidated(pair.home));
  EXPECT_EQ(pair.server.room(), pair.server.maxPayload());
}

TEST(SealedLink, OtherLocalAddressIsAnotherPath) {
  LinkPair pair;
  pair.settle(pair.home);
  Path other = pair.home;
  other.local = *makeEndpoint("192.0.2.2", 9876);
  pair.toServer(pair.fromClient("x"), other);
  EXPECT_EQ(pair.seal(pair.server, "y")->path, other);  // replies leave from the address that was addressed
}

TEST(SealedLink, RandomPacketsDoNoHarm) {
  SplitMix64 rng(8);
  LinkPair pair;
  pair.settle(pair.home);
  const std::string model = pair.fromClient("something real");
  const std::uint64_t opened = pair.server.counters().opened;
  for (int i = 0; i < 100'000; ++i) {
    std::string packet = rng.below(2) ? model : std::string(rng.below(1300), '\0');
    for (std::uint64_t flips = 1 + rng.below(20); flips > 0 && !packet.empty(); --flips) {
      packet[rng.below(packet.size())] = static_cast<char>(rng.next());
    }
    if (packet == model) continue;
    ASSERT_EQ(pair.toServer(packet), "<refused>");
    ASSERT_EQ(pair.toClient(packet), "<refused>");
  }
  EXPECT_EQ(pair.server.counters().opened, opened);
  EXPECT_EQ(pair.toServer(model), "something real");
}

TEST(SealedLink, PacketsCostNoAllocation) {
  if (!canCountAllocations()) GTEST_SKIP() << "sanitizers bring their own allocator";
  LinkPair pair;
  pair.settle(pair.home);
  const std::string payload(100, 'x');
  bool well = true;
  const auto one = [&] {
    const auto up = pair.client.seal(payload, pair.now);
    well = well && up && pair.server.open(pair.home, up->packet, pair.now);
    const auto down = pair.server.seal(payload, pair.now);
    well = well && down && pair.client.open(pair.server_path, down->packet, pair.now);
  };
  one();
  const std::uint64_t before = allocationsSoFar();
  for (int i = 0; i < 1000; ++i) one();
  EXPECT_EQ(allocationsSoFar(), before);
  EXPECT_TRUE(well);
}

}  // namespace
}  // namespace naiad::test
