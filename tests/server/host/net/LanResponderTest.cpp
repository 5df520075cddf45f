// The responder with real sockets, queried as by clients, and flooded.
#include <gtest/gtest.h>
#include <poll.h>
#include <unistd.h>

#include <memory>
#include <optional>
#include <set>

#include "host/net/LanResponder.h"
#include "tests/support/net/LanLock.h"

namespace naiad {
namespace {

using namespace std::chrono_literals;

const LanNonce kResponderNonce{9, 8, 7};

/// Returns the loopback network of this family; nullopt if the machine has none that can multicast.
std::optional<LanNetwork> responderNetwork(LanSocket::Family family) {
  const bool four = family == LanSocket::Family::kIPv4;
  for (const LanNetwork& network : lanNetworks()) {
    if (network.address.is_v4() == four && network.is_loopback == four) return network;
  }
  return std::nullopt;
}

/// Returns a key that starts with `key` and is unique to this process, because tests that run in parallel
/// have servers in these networks, too.
ShortKey responderKey(std::uint8_t key) {
  const auto process = static_cast<std::uint32_t>(getpid());
  ShortKey::Bytes bytes{key};
  for (int i = 0; i < 4; ++i) bytes[1 + i] = static_cast<std::uint8_t>(process >> (8 * i));
  return ShortKey::ofBytes(bytes);
}

LanAnswer responderFacts(std::uint8_t key, bool requires_password = false) {
  LanAnswer facts;
  facts.protocol = 4;
  facts.port = 9876;
  facts.max_players = 16;
  facts.name = "responder";
  facts.requires_password = requires_password;
  facts.key = responderKey(key);
  return facts;
}

class LanResponderTest : public testing::TestWithParam<LanSocket::Family> {
 protected:
  void SetUp() override {
    m_network = responderNetwork(GetParam());
    if (!m_network) GTEST_SKIP() << "this machine is in no network of the family";
    m_client.emplace(LanSocket::forClient(GetParam()));
  }

  std::unique_ptr<LanResponder> respond(std::uint8_t key) {
    const char* p_address = GetParam() == LanSocket::Family::kIPv4 ? "127.0.0.1" : "::";
    auto responder = std::make_unique<LanResponder>(responderFacts(key), p_address, LanMode::kOn);
    responder->setPlayers(5);
    responder->start();
    return responder;
  }
  bool ask(const std::string& bytes) { return m_client->sendQuery(*m_network, bytes); }
  bool ask() { return ask(writeLanQuery(m_nonce)); }
  std::optional<LanPacket> hear(std::chrono::milliseconds patience) {
    pollfd waited{m_client->descriptor(), POLLIN, 0};
    ::poll(&waited, 1, static_cast<int>(patience.count()));
    return m_client->receivePacket();
  }
  /// Queries until servers with all these keys have answered. Ignores other servers and late answers. False
  /// after a minute.
  bool hearAll(const std::set<std::uint8_t>& keys) {
    ++m_nonce.front();
    const auto end = std::chrono::steady_clock::now() + 60s;
    std::set<std::uint8_t> heard;
    while (std::chrono::steady_clock::now() < end) {
      ask();
      while (const auto packet = hear(500ms)) {
        const auto answer = readLanAnswer(packet->bytes);
        for (const std::uint8_t key : keys) {
          if (!answer || answer->nonce != m_nonce || answer->key != responderKey(key)) continue;
          m_last = *answer;
          m_last_packet = *packet;
          heard.insert(key);
        }
        if (heard == keys) return true;
      }
    }
    return false;
  }

  test::LanLock m_lock;
  std::optional<LanNetwork> m_network;
  std::optional<LanSocket> m_client;
  LanNonce m_nonce = kResponderNonce;
  LanAnswer m_last;
  LanPacket m_last_packet;
};

TEST_P(LanResponderTest, AnswersWithFullHopLimitAndPlayerCount) {
  const auto responder = respond(1);
  ASSERT_TRUE(hearAll({1}));
  EXPECT_EQ(m_last_packet.hop_limit, 255);
  EXPECT_EQ(m_last_packet.source.port(), kLanPort);
  EXPECT_EQ(m_last_packet.source.address(), m_network->address);
  EXPECT_EQ(m_last.players, 5);
  EXPECT_EQ(m_last.max_players, 16);
  EXPECT_EQ(m_last.port, 9876);
}

TEST_P(LanResponderTest, SeveralServersOfAMachineAreAllFound) {
  const auto one = respond(11);
  const auto two = respond(12);
  EXPECT_TRUE(hearAll({11, 12}));
}

TEST_P(LanResponderTest, FloodsAreAnsweredAtALimitedRate) {
  const auto begin = std::chrono::steady_clock::now();
  const auto responder = respond(31);
  ASSERT_TRUE(hearAll({31}));
  for (int i = 0; i < 2000; ++i) ask(i % 2 == 0 ? "nlan" : std::string(512, 'x'));
  ASSERT_TRUE(hearAll({31}));
  for (int i = 0; i < 2000; ++i) ask();
  ASSERT_TRUE(hearAll({31}));
  responder->stop();
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
  EXPECT_GT(responder->counters().malformed, 0u);
  EXPECT_GE(responder->counters().answered, 3u);
  // Other tests on this machine may query at this time, from its other addresses.
  EXPECT_LE(static_cast<double>(responder->counters().answered),
            LanQueryFilter::kTotalRate.burst + LanQueryFilter::kTotalRate.per_second * took.count());
  EXPECT_GT(responder->counters().rate_limited, 0u);
}

TEST_P(LanResponderTest, NothingIsAnsweredAfterStop) {
  const auto responder = respond(41);
  ASSERT_TRUE(hearAll({41}));
  responder->stop();
  const std::uint64_t answered = responder->counters().answered;
  ask();
  while (const auto packet = hear(0ms)) {
  }
  EXPECT_EQ(responder->counters().answered, answered);
}

INSTANTIATE_TEST_SUITE_P(Families, LanResponderTest,
                         testing::Values(LanSocket::Family::kIPv4, LanSocket::Family::kIPv6),
                         [](const auto& family) {
                           return family.param == LanSocket::Family::kIPv4 ? "IPv4" : "IPv6";
                         });

}  // namespace
}  // namespace naiad
