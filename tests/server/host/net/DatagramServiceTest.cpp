#include <gtest/gtest.h>

#include <deque>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "host/net/DatagramService.h"
#include "shared/values/SplitMix64.h"
#include "tests/support/net/VirtualNetwork.h"

namespace naiad {
namespace {

using namespace std::chrono_literals;

Endpoint at(const char* address, std::uint16_t port = 9876) {
  return *makeEndpoint(address, port);
}

/// Returns the key exporter of the `nth` simulated TLS connection.
KeyExporter stream(int nth) {
  return [nth](std::string_view label, std::string_view context, std::size_t bytes) {
    const std::string all = std::to_string(nth) + std::string(label) + std::string(context);
    SplitMix64 random(std::hash<std::string>{}(all));
    std::string secret(bytes, '\0');
    for (char& c : secret) c = static_cast<char>(random.next());
    return secret;
  };
}

class DatagramServiceTest : public testing::Test {
 protected:
  using Time = std::chrono::steady_clock::time_point;

  DatagramServiceTest()
      : network(clock, LinkConditions{.delay = 10ms}, 1),
        socket(network.open(at("10.0.0.1")).release()),
        service(
            std::unique_ptr<DatagramSocket>(socket), [this] { return now(); },
            [this] {
              if (next_random.empty()) return random.next();
              const std::uint64_t bits = next_random.front();
              next_random.pop_front();
              return bits;
            }) {
    network.setTap(
        [this](const Endpoint& from, const Endpoint&, std::string_view) { ++packets[from.address[15]]; });
  }
  Time now() const { return Time(1h) + clock.now(); }
  void pass(std::chrono::milliseconds time) {
    for (auto left = time; left.count() > 0; left -= 10ms) {
      clock.advanceBy(10ms);
      service.flush();
    }
  }
  int answers() { return packets[1]; }

  struct Client {
    Client(DatagramServiceTest& of, const DatagramService::Channel& channel, int nth, const char* address)
        : test(of),
          link({SealedLink::Role::kClient, ConnectionId{channel.id()}, {}, {}}),
          socket(test.network.open(at(address, 0))),
          aead(channel.aead()) {
      link.setServerPath({{}, at("10.0.0.1")});
      renew(nth, channel.epoch());
      socket->start([this](const Path& path, std::string_view packet) {
        const auto payload = link.open(path, packet, test.now());
        if (!payload) return;
        if (link.needsToSend(test.now())) send("");
        if (!payload->empty()) heard.emplace_back(*payload);
      });
    }
    void renew(int nth, Epoch epoch) {
      ASSERT_TRUE(
          link.startEpoch(epoch, deriveDatagramKeys(stream(nth), aead, link.id(), epoch), test.now()));
    }
    void send(std::string_view payload) {
      const auto outgoing = link.seal(payload, test.now());
      ASSERT_TRUE(outgoing);
      socket->send(outgoing->path, outgoing->packet);
      socket->flush();
    }
    DatagramServiceTest& test;
    SealedLink link;
    std::unique_ptr<DatagramSocket> socket;
    AeadId aead;
    std::vector<std::string> heard;
  };
  std::unique_ptr<DatagramService::Channel> open(int nth, std::vector<std::string>& heard,
                                                 AeadId aead = AeadId::kAes128Gcm) {
    auto channel = service.open(stream(nth), aead);
    if (channel) channel->start([&heard](std::string_view packet) { heard.emplace_back(packet); });
    return channel;
  }
  void say(DatagramService::Channel& channel, std::string_view what) {
    channel.send(what);
    service.flush();
  }
  using Heard = std::vector<std::string>;

  VirtualClock clock;
  VirtualNetwork network;
  SplitMix64 random{9};
  std::deque<std::uint64_t> next_random;
  DatagramSocket* socket;
  std::map<std::uint8_t, int> packets;  ///< sent datagrams, by the last byte of the sender's address
  DatagramService service;
  Heard one, two;
};

TEST_F(DatagramServiceTest, SendsNothingBeforeHearingFromTheClient) {
  const auto channel = open(1, one);
  ASSERT_TRUE(channel);
  EXPECT_EQ(channel->payloadBudget(), std::nullopt);
  EXPECT_EQ(channel->peerAddress(), "nowhere");
  say(*channel, "hello?");
  pass(1s);
  EXPECT_EQ(answers(), 0);
  EXPECT_EQ(channel->counters().no_path, 1u);
}

TEST_F(DatagramServiceTest, CarriesPayloadsBothWaysWithBothCiphers) {
  for (const AeadId aead : {AeadId::kAes128Gcm, AeadId::kChaCha20Poly1305}) {
    one.clear();
    const auto channel = open(1, one, aead);
    Client ann(*this, *channel, 1, "10.0.0.2");
    ann.send("up");
    pass(100ms);
    EXPECT_EQ(one, Heard{"up"});
    say(*channel, "down");
    pass(100ms);
    EXPECT_EQ(ann.heard, Heard{"down"});
    EXPECT_EQ(channel->peerAddress(), toString(ann.socket->localEndpoint()));
    EXPECT_TRUE(channel->payloadBudget());
  }
}

TEST_F(DatagramServiceTest, EachSessionReceivesOnlyItsOwnPayloads) {
  const auto first = open(1, one);
  const auto second = open(2, two);
  EXPECT_NE(first->id(), second->id());
  Client ann(*this, *first, 1, "10.0.0.2");
  Client ben(*this, *second, 2, "10.0.0.3");
  ann.send("I am Ann");
  ben.send("I am Ben");
  pass(100ms);
  EXPECT_EQ(one, Heard{"I am Ann"});
  EXPECT_EQ(two, Heard{"I am Ben"});
  say(*first, "to Ann");
  pass(100ms);
  EXPECT_EQ(ann.heard, Heard{"to Ann"});
  EXPECT_EQ(ben.heard, Heard{});
}

TEST_F(DatagramServiceTest, AStreamWithoutKeysHasNoDatagrams) {
  const auto none = [](std::string_view, std::string_view, std::size_t) { return std::string(); };
  EXPECT_EQ(service.open(none, AeadId::kAes128Gcm), nullptr);
  const auto channel = open(1, one);
  EXPECT_FALSE(channel->renew(none, channel->epoch() + 1));
  Client ann(*this, *channel, 1, "10.0.0.2");
  ann.send("still here");
  pass(100ms);
  EXPECT_EQ(one, Heard{"still here"});
}

TEST_F(DatagramServiceTest, DuplicateIdIsRedrawnAndItsOwnerKeepsIt) {
  next_random = {5};
  const auto first = open(1, one);
  EXPECT_EQ(first->id(), 5u);
  next_random = {5, 6};
  const auto second = open(2, two);
  EXPECT_EQ(second->id(), 6u);
  Client ann(*this, *first, 1, "10.0.0.2");
  ann.send("mine");
  pass(100ms);
  EXPECT_EQ(one, Heard{"mine"});
}

TEST_F(DatagramServiceTest, DestroyedChannelNeitherReceivesNorSends) {
  auto channel = open(1, one);
  Client ann(*this, *channel, 1, "10.0.0.2");
  ann.send("first");
  pass(500ms);
  const int before = answers();
  channel.reset();
  ann.send("second");
  pass(1s);
  EXPECT_EQ(one, Heard{"first"});
  EXPECT_EQ(answers(), before);
  EXPECT_EQ(service.counters().unknown_id, 1u);
}

TEST_F(DatagramServiceTest, UnvalidatedAddressReceivesFewBytes) {
  const auto channel = open(1, one);
  Client ann(*this, *channel, 1, "10.0.0.2");
  ann.send("I pretend to be another client");
  network.block(*ann.socket, false, true);
  std::size_t bytes = 0;
  network.setTap([&](const Endpoint& from, const Endpoint&, std::string_view packet) {
    if (from == at("10.0.0.1")) bytes += packet.size();
  });
  for (int i = 0; i < 50; ++i) {
    say(*channel, std::string(20, 'x'));
    pass(100ms);
  }
  EXPECT_GT(bytes, 0u);
  EXPECT_LE(bytes, 3u * 200);
  EXPECT_GT(channel->counters().over_budget, 0u);
}

TEST_F(DatagramServiceTest, ForgedDatagramsAreNeverAnswered) {
  const auto channel = open(1, one);
  Client ann(*this, *channel, 1, "10.0.0.2");
  Client liar(*this, *channel, 2, "10.0.0.3");  // knows the id, not the keys
  ann.send("here");
  pass(1s);
  const int before = answers();
  const Heard heard = one;
  for (int i = 0; i < 100; ++i) {
    liar.send("here, too");
    std::string noise(1 + random.below(1300), '\0');
    for (char& c : noise) c = static_cast<char>(random.next());
    network.spoof(at("10.0.0.66"), at("10.0.0.1"), noise);
    network.spoof(ann.socket->localEndpoint(), at("10.0.0.1"), noise);
    pass(20ms);
  }
  EXPECT_EQ(answers(), before);
  EXPECT_EQ(one, heard);
  EXPECT_EQ(channel->peerAddress(), toString(ann.socket->localEndpoint()));
  EXPECT_GT(channel->counters().forged, 0u);
  EXPECT_EQ(service.counters().delivered, one.size() + 1) << "and the answer to the challenge";
}

}  // namespace
}  // namespace naiad
