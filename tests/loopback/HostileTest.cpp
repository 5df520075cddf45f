// Hostile bytes end the connection that sent them, are counted, and change nothing for other players. Hostile
// datagrams get no answer.
#include <gtest/gtest.h>

#include <asio/ip/udp.hpp>
#include <cstdio>
#include <vector>

#include "Compare.h"
#include "LoopbackFixture.h"
#include "RawClient.h"
#include "engine/world/Player.h"
#include "engine/world/Views.h"
#include "shared/net/stream/Framing.h"
#include "shared/replica/UpdateCodec.h"
#include "shared/values/SplitMix64.h"

namespace naiad::test {
namespace {

using asio::ip::udp;

std::string randomBytes(SplitMix64& random, std::size_t count) {
  std::string bytes;
  for (std::size_t i = 0; i < count; ++i) bytes.push_back(static_cast<char>(random.below(256)));
  return bytes;
}

std::string keyUpdate(std::uint32_t id, std::uint64_t key) {
  ClientUpdate update;
  update.inputs.resize(1);
  update.inputs[0].id = id;
  update.inputs[0].key = static_cast<std::uint8_t>(key);
  return writeUpdate(update);
}

wire::ClientMessage validMessage(SplitMix64& random) {
  wire::ClientMessage message;
  switch (random.below(4)) {
    case 0:
      message.set_update(keyUpdate(1 + static_cast<std::uint32_t>(random.below(5)), random.below(80)));
      break;
    case 1: {
      ClientUpdate update;
      update.acks = {static_cast<std::uint32_t>(random.next()), random.next()};
      message.set_update(writeUpdate(update));
      break;
    }
    case 2:
      message.mutable_chat()->set_text(randomBytes(random, 20));
      break;
    default:
      message.mutable_ping()->set_token(random.next());
      break;
  }
  return message;
}

/// One attack: malformed, truncated, oversized, out of range or plain random bytes.
void attack(SplitMix64& random, RawClient& client) {
  const std::uint64_t kind = random.below(7);
  if (kind != 0) client.send(RawClient::hello("evil"));
  switch (kind) {
    case 0:  // random bytes instead of a greeting
      client.sendBytes(randomBytes(random, 1 + random.below(300)));
      break;
    case 1:  // random bytes in a frame
      client.sendFrame(randomBytes(random, 1 + random.below(300)));
      break;
    case 2:  // a frame over the limit
      client.sendBytes(std::string("\xff\xff", 2) + randomBytes(random, 100));
      break;
    case 3:  // an empty frame
      client.sendBytes(std::string(2, '\0'));
      break;
    case 4: {  // a truncated message, and the stream ends within a frame
      std::string bytes;
      appendFrame(bytes, validMessage(random).SerializeAsString());
      client.sendBytes(bytes.substr(0, 1 + random.below(bytes.size())));
      break;
    }
    case 5: {  // a message with bits flipped
      std::string payload = validMessage(random).SerializeAsString();
      for (int i = 0; i < 3; ++i)
        payload[random.below(payload.size())] ^= static_cast<char>(1 << random.below(8));
      client.sendFrame(payload);
      break;
    }
    default: {  // well-formed, out of range
      wire::ClientMessage message;
      message.set_update(keyUpdate(1, df::Keyboard::kKeyCount + random.below(40)));
      client.send(message);
      break;
    }
  }
}

/// Uses encrypted connections and, unless a test changes it, the default grace time for disconnected players.
class Hostile : public LoopbackFixture {
 protected:
  /// Returns a setup without datagrams, because pictures from the stream are never provisional.
  ClientSetup player(const std::string& name) const {
    ClientSetup setup = home.player(name);
    setup.options.open_socket = [](const Endpoint&) { return nullptr; };
    return setup;
  }
};
constexpr auto kTls = RawClient::Line::kTls;

TEST_F(Hostile, AThousandBadFramesChangeNothingForTheOthers) {
  HostOptions options = home.server();
  options.grace = 0.1;            // short, because the test also keeps pictures of detached attackers
  options.max_per_address = 500;  // a burst of twice as many joins is allowed (RateLimits)
  TestServer server(busyWorld(50), options);
  TestClient ann(context, server.port(), player("ann"));
  ASSERT_TRUE(serve(ann, [&] { return ann.joined(); }));

  SplitMix64 random(42);
  for (int i = 0; i < 1000; ++i) {
    RawClient evil(server.port(), kTls);
    attack(random, evil);
    // A reset may discard bytes, so most attackers wait until the server has read all of theirs.
    if (i % 10 == 0) {
      evil.reset();
    } else {
      ASSERT_TRUE(evil.finish()) << "attack " << i;
    }
    ann.connection().update(std::chrono::steady_clock::now());
    context.restart();
    context.poll();
    if (i % 20 != 0) continue;
    const std::uint32_t tick = ann.newestTick();
    ASSERT_TRUE(serve(ann, [&] { return ann.newestTick() > tick; })) << "after attack " << i;
  }
  // After the last attacker is removed, Ann plays alone and undisturbed.
  ASSERT_TRUE(serve(ann, [&] {
    return ann.pictures().size() >= 100 &&
           server.inWorld([](df::World& world) { return world.views().getPlayers().size(); }) == 1;
  }));
  expectSame(ann, server, 100);
  EXPECT_EQ(ann.session().state(), ClientSession::State::kPlaying);
  const Counters counters = server.counters();
  EXPECT_GT(counters.malformed_frames, 200u);
  EXPECT_GT(counters.malformed_messages, 200u);
  std::printf("counted: %s\n", counters.summary().c_str());
}

TEST_F(Hostile, GarbageAndForgedDatagramsAreNeverAnswered) {
  TestServer server(busyWorld(20), home.server());
  TestClient ann(context, server.port(), playerWithValve("ann"));
  ASSERT_TRUE(settles(ann));
  ann.session().sendKey(df::Keyboard::RIGHTARROW, df::KEY_PRESSED, Clock::now());
  ASSERT_TRUE(serve(ann, [&] { return ann.session().score() == 1; }));

  udp::socket attacker(context, udp::endpoint(asio::ip::address_v4::loopback(), 0));
  attacker.non_blocking(true);
  const udp::endpoint target(asio::ip::address_v4::loopback(), server.port());
  SplitMix64 random(11);
  const auto strike = [&](std::string bytes) {
    asio::error_code ignored;
    attacker.send_to(asio::buffer(bytes), target, 0, ignored);
  };
  const std::vector<std::string> genuine = valve->seen;
  ASSERT_GT(genuine.size(), 5u);
  for (int i = 0; i < 2000; ++i) {
    std::string bytes = genuine[random.below(genuine.size())];
    switch (random.below(5)) {
      case 0:  // random bytes of any length
        bytes.resize(1 + random.below(1400));
        for (char& c : bytes) c = static_cast<char>(random.next());
        break;
      case 1:  // a flipped bit
        bytes[random.below(bytes.size())] ^= static_cast<char>(1 << random.below(8));
        break;
      case 2:  // truncated
        bytes.resize(random.below(bytes.size()));
        break;
      case 3:  // the header of an authentic datagram, with another body
        for (std::size_t k = 11; k < bytes.size(); ++k) bytes[k] = static_cast<char>(random.next());
        break;
      default:  // captured and replayed
        break;
    }
    strike(bytes);
    if (i % 100 == 0) {
      ASSERT_TRUE(hears(ann, 3));
    }
  }
  ASSERT_TRUE(hears(ann, 100));
  EXPECT_EQ(attacker.available(), 0u) << "not a byte came back";
  EXPECT_TRUE(ann.session().hasDatagrams(Clock::now()));
  EXPECT_EQ(server.inWorld([&](df::World& world) { return world.views().player(ann.player())->getScore(); }),
            1);
  EXPECT_EQ(server.counters().malformed_messages, 0u);
  EXPECT_EQ(server.counters().message_floods, 0u);
  EXPECT_EQ(ann.session().state(), ClientSession::State::kPlaying);
}

}  // namespace
}  // namespace naiad::test
