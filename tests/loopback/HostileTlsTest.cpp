// Hostile datagrams get no answer and change nothing.
#include <gtest/gtest.h>

#include <asio/ip/udp.hpp>
#include <atomic>
#include <thread>
#include <vector>

#include "LoopbackFixture.h"
#include "Valve.h"
#include "engine/world/Player.h"
#include "engine/world/Views.h"
#include "shared/values/SplitMix64.h"

namespace naiad::test {
namespace {

using asio::ip::udp;
using Clock = std::chrono::steady_clock;

class HostileTls : public LoopbackFixture {
 protected:
  ClientSetup player(const std::string& name) {
    ClientSetup setup = home.player(name);
    setup.options.open_socket = through(context, valve);
    return setup;
  }
  static int scoreOf(TestServer& server, std::uint32_t player) {
    return server.inWorld([player](df::World& world) { return world.views().player(player)->getScore(); });
  }

  std::shared_ptr<Valve> valve = std::make_shared<Valve>();
};

TEST_F(HostileTls, GarbageAndForgeriesAreNeverAnswered) {
  TestServer server(busyWorld(20), home.server());
  TestClient ann(context, server.port(), player("ann"));
  ASSERT_TRUE(settles(ann));
  ann.session().sendKey(df::Keyboard::RIGHTARROW, df::KEY_PRESSED, Clock::now());
  ASSERT_TRUE(serveUntil(context, {&ann}, [&] { return ann.session().score() == 1; }));

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
  EXPECT_EQ(scoreOf(server, ann.player()), 1);
  EXPECT_EQ(server.counters().malformed_messages, 0u);
  EXPECT_EQ(server.counters().message_floods, 0u);
  EXPECT_EQ(ann.session().state(), ClientSession::State::kPlaying);
}

TEST_F(HostileTls, DatagramFloodDoesNotStopTheGame) {
  TestServer server(busyWorld(20), home.server());
  TestClient ann(context, server.port(), player("ann"));
  ASSERT_TRUE(settles(ann));
  const std::vector<std::string> genuine = valve->seen;
  std::atomic<bool> done = false;
  std::thread flood([&, port = server.port()] {
    asio::io_context own;
    udp::socket socket(own, udp::endpoint(asio::ip::address_v4::loopback(), 0));
    SplitMix64 random(5);
    while (!done) {
      std::string bytes = genuine[random.below(genuine.size())];
      bytes[11 + random.below(bytes.size() - 11)] ^= 1;
      asio::error_code ignored;
      socket.send_to(asio::buffer(bytes), {asio::ip::address_v4::loopback(), port}, 0, ignored);
    }
  });
  EXPECT_TRUE(hears(ann, 300));
  done = true;
  flood.join();
  EXPECT_EQ(ann.session().state(), ClientSession::State::kPlaying);
  EXPECT_EQ(server.counters().detached, 0u);
  EXPECT_TRUE(settles(ann));
}

}  // namespace
}  // namespace naiad::test
