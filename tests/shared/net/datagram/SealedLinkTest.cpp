#include <gtest/gtest.h>
#include <openssl/evp.h>

#include <string>

#include "LinkPair.h"
#include "shared/net/datagram/SealedLink.h"
#include "tests/support/AllocationCount.h"

namespace naiad::test {
namespace {

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
  EXPECT_FALSE(pair.server.needsToSend(pair.now));
  EXPECT_FALSE(pair.server.payloadBudget());
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

TEST(SealedLink, LargestPayloadsAlwaysFitExactly) {
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
  EXPECT_EQ(pair.fromServer("").size(), smallestSealedPacket(SealDirection::kServerToClient));
  EXPECT_EQ(pair.fromClient("").size(), smallestSealedPacket(SealDirection::kClientToServer));
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
  EXPECT_EQ(pair.toServer(changed(0, 0x30)), "<refused>");  // the kind of packets that the server sends
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

TEST(SealedLink, AuthenticMalformedPacketsAreCountedAndIgnored) {
  LinkPair pair;
  pair.toServer(pair.fromClient("x"));
  Sealer sealer(pair.keys(0).client);
  const auto seal = [&](std::string_view text) {
    std::string packet(kMaxDatagram, '\0');
    const std::size_t prefix = writeSealedPrefix(SealDirection::kClientToServer, 0, kSession, packet.data());
    packet.replace(prefix + 2, text.size(), text);
    packet.resize(sealer.seal(packet.data(), prefix, text.size()));
    return packet;
  };
  seal("\0");  // uses up number 0
  const Path elsewhere = pathFrom("203.0.113.1");
  // A challenge to a server, reserved flags, a truncated answer.
  for (const std::string& text :
       {'\x01' + "12345678"s, "\x04"s, "\x80"s, '\x03' + "1234567812345678"s, '\x02' + "1234567"s}) {
    EXPECT_EQ(pair.toServer(seal(text), elsewhere), "<refused>");
  }
  EXPECT_EQ(pair.server.counters().malformed, 5u);
  EXPECT_EQ(pair.server.path(), pair.home);
  EXPECT_EQ(pair.toServer(seal('\x02' + "12345678and so on"s), elsewhere), "and so on");
  EXPECT_EQ(pair.server.counters().wrong_answers, 1u);
}

TEST(SealedLink, PacketsCostNoAllocation) {
  if (!canCountAllocations()) GTEST_SKIP() << "sanitizers bring their own allocator";
  for (const AeadId aead : kBothAeads) {
    LinkPair pair(aead);
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

}  // namespace
}  // namespace naiad::test
