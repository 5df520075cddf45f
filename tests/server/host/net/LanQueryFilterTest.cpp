#include <gtest/gtest.h>

#include "host/net/LanResponder.h"

namespace naiad {
namespace {

using namespace std::chrono_literals;
using asio::ip::make_address;

const LanNonce kNonce{1, 2, 3};
const LanQueryFilter::Time kBegin{std::chrono::hours(1)};

LanNetwork lanAt(unsigned interface, const std::string& address, unsigned prefix, bool is_private = true) {
  const auto parsed = make_address(address);
  return {interface, "if" + std::to_string(interface), parsed, prefix, parsed.is_loopback(), is_private};
}

LanAnswer lanFacts() {
  LanAnswer answer;
  answer.port = 9876;
  answer.max_players = 16;
  answer.name = "test";
  answer.game = "hello";
  return answer;
}

/// The query of an honest client.
struct Query {
  explicit Query(const std::string& from = "192.168.1.20", unsigned interface = 2) {
    packet.source = {make_address(from), 40'000};
    packet.interface = interface;
    packet.hop_limit = 255;
    packet.to_group = true;
    packet.bytes = bytes;
  }
  std::string bytes = writeLanQuery(kNonce);
  LanPacket packet;
};

class LanQueryFilterTest : public testing::Test {
 protected:
  LanQueryFilterTest() {
    judge.setNetworks({lanAt(1, "127.0.0.1", 8), lanAt(2, "192.168.1.5", 24), lanAt(2, "fe80::5", 64),
                       lanAt(3, "10.0.0.5", 8)});
  }
  bool answers(const LanPacket& packet, LanQueryFilter::Time now = kBegin) {
    return judge.filter(packet, 3, now).has_value();
  }
  LanQueryFilter judge{lanFacts()};
};

TEST_F(LanQueryFilterTest, HonestQueryIsAnsweredFromItsNetworksAddress) {
  const Query query;
  const auto reply = judge.filter(query.packet, 3, kBegin);
  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->p_network->address, make_address("192.168.1.5"));
  LanAnswer wanted = lanFacts();
  wanted.nonce = kNonce;
  wanted.players = 3;
  EXPECT_EQ(readLanAnswer(reply->bytes), wanted);
  EXPECT_LE(reply->bytes.size(), query.bytes.size());
  EXPECT_EQ(judge.counters().answered, 1u);
}

TEST_F(LanQueryFilterTest, RoutedQueriesAreNotAnswered) {
  for (const int hops : {0, 1, 64, 254, 256}) {
    Query query;
    query.packet.hop_limit = hops;
    EXPECT_FALSE(answers(query.packet)) << hops;
  }
  EXPECT_EQ(judge.counters().routed, 5u);
}

TEST_F(LanQueryFilterTest, ForgedSourcesAreNotAnswered) {
  for (const char* p_from : {"203.0.113.9", "192.168.2.20", "10.0.0.7", "127.0.0.1", "2001:db8::1", "::1"})
    EXPECT_FALSE(answers(Query(p_from).packet)) << p_from;
  EXPECT_FALSE(answers(Query("192.168.1.20", 3).packet)) << "another interface";
  EXPECT_FALSE(answers(Query("192.168.1.20", 0).packet));
  EXPECT_FALSE(answers(Query("192.168.1.20", 1).packet)) << "loopback";
  Query query;
  query.packet.to_group = false;
  EXPECT_FALSE(answers(query.packet)) << "sent to the machine alone";
  query = Query();
  query.packet.source.port(0);
  query.packet.bytes = query.bytes;
  EXPECT_FALSE(answers(query.packet));
  EXPECT_EQ(judge.counters().foreign, 11u);
  EXPECT_TRUE(answers(Query("fe80::9").packet));
  EXPECT_TRUE(answers(Query("127.0.0.1", 1).packet));
}

TEST_F(LanQueryFilterTest, QueriesThatAreTooShortAreNotAnswered) {
  for (const std::size_t size : {0u, 1u, 24u, 370u, 511u}) {
    Query query;
    query.packet.bytes = query.packet.bytes.substr(0, size);
    EXPECT_FALSE(answers(query.packet)) << size;
  }
  EXPECT_EQ(judge.counters().malformed, 5u);
}

TEST_F(LanQueryFilterTest, SenderGetsTwoAnswersASecondWithoutStarvingOthers) {
  int answered = 0;
  for (int i = 0; i < 10'000; ++i) answered += answers(Query().packet, kBegin + i * 1ms) ? 1 : 0;
  EXPECT_GE(answered, 4 + 2 * 9);
  EXPECT_LE(answered, 4 + 2 * 10);
  EXPECT_TRUE(answers(Query("192.168.1.21").packet, kBegin + 10s));
  EXPECT_EQ(judge.counters().rate_limited, 10'000u - static_cast<unsigned>(answered));
}

TEST_F(LanQueryFilterTest, SpoofedNeighbourFloodIsAnsweredTenTimesASecond) {
  int answered = 0;
  for (int i = 0; i < 10'000; ++i) {
    const std::string from = "10.0." + std::to_string(i / 250) + "." + std::to_string(1 + i % 250);
    answered += answers(Query(from, 3).packet, kBegin + i * 1ms) ? 1 : 0;
  }
  EXPECT_GE(answered, 10 + 10 * 9);
  EXPECT_LE(answered, 10 + 10 * 10);
}

TEST_F(LanQueryFilterTest, UnsentAnswerIsNotCountedAsAnswered) {
  ASSERT_TRUE(answers(Query().packet));
  judge.countUnsent();
  EXPECT_EQ(judge.counters().answered, 0u);
  EXPECT_EQ(judge.counters().unsent, 1u);
}

TEST(AnsweredNetworks, ModeAndListeningAddressSelectThem) {
  using Addresses = std::vector<std::string>;
  struct Row {
    LanMode mode;
    std::string address;  ///< address on which the server listens
    Addresses answered;
    bool has_private = true;  ///< the machine is in a private network, too
  };
  const Row rows[] = {
      {LanMode::kAuto, "::", {"127.0.0.1", "::1", "192.168.1.5", "fd00::5"}},
      {LanMode::kAuto, "0.0.0.0", {"127.0.0.1", "192.168.1.5"}},
      {LanMode::kAuto, "192.168.1.5", {"192.168.1.5"}},
      {LanMode::kAuto, "198.51.100.5", {}},
      {LanMode::kAuto, "::", {}, false},
      {LanMode::kAuto, "127.0.0.1", {}},
      {LanMode::kAuto, "::1", {}},
      {LanMode::kOn, "::", {"127.0.0.1", "::1", "198.51.100.5", "fe80::3", "192.168.1.5", "fd00::5"}},
      {LanMode::kOn, "127.0.0.1", {"127.0.0.1"}},
      {LanMode::kOn, "198.51.100.5", {"198.51.100.5"}},
      {LanMode::kOff, "::", {}}};
  for (const auto& [mode, address, answered, has_private] : rows) {
    std::vector<LanNetwork> all{lanAt(1, "127.0.0.1", 8, false), lanAt(1, "::1", 128, false),
                                lanAt(3, "198.51.100.5", 24, false), lanAt(3, "fe80::3", 64, false)};
    if (has_private) all.insert(all.end(), {lanAt(2, "192.168.1.5", 24), lanAt(2, "fd00::5", 64)});
    Addresses found;
    for (const LanNetwork& one : answeredNetworks(all, address, mode))
      found.push_back(one.address.to_string());
    EXPECT_EQ(found, answered) << address << ", mode " << static_cast<int>(mode);
  }
}

}  // namespace
}  // namespace naiad
