// Hostile datagrams and half-open connections get no answer and change nothing.
#include <gtest/gtest.h>

#include <algorithm>
#include <asio/ip/tcp.hpp>
#include <asio/ip/udp.hpp>
#include <asio/write.hpp>
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

/// Records the datagrams that it sends, so that an attacker can replay them.
class Sniffed : public DatagramSocket {
 public:
  Sniffed(std::unique_ptr<DatagramSocket> socket, std::vector<std::string>& seen)
      : m_socket(std::move(socket)), m_seen(seen) {}
  void start(OnPacket on_packet) override { m_socket->start(std::move(on_packet)); }
  void send(const Path& path, std::string_view packet) override {
    m_seen.emplace_back(packet);
    m_socket->send(path, packet);
  }
  void flush() override { m_socket->flush(); }
  void reopen() override { m_socket->reopen(); }
  Endpoint localEndpoint() const override { return m_socket->localEndpoint(); }

 private:
  std::unique_ptr<DatagramSocket> m_socket;
  std::vector<std::string>& m_seen;
};

class HostileTls : public LoopbackFixture {
 protected:
  ClientSetup player(const std::string& name) {
    ClientSetup setup = home.player(name);
    setup.options.open_socket = [this, open = through(context, valve)](const Endpoint& server) {
      return std::make_unique<Sniffed>(open(server), seen);
    };
    return setup;
  }
  static int scoreOf(TestServer& server, std::uint32_t player) {
    return server.inWorld([player](df::World& world) { return world.views().player(player)->getScore(); });
  }

  std::shared_ptr<Valve> valve = std::make_shared<Valve>();
  std::vector<std::string> seen;  ///< datagrams sent by the client
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
  const std::vector<std::string> genuine = seen;
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

TEST_F(HostileTls, ReplayOfAHeldBackDatagramHasNoEffect) {
  TestServer server(busyWorld(20), home.server());
  TestClient ann(context, server.port(), player("ann"));
  ASSERT_TRUE(settles(ann));
  // An authentic datagram that never arrived, replayed after a newer one from the current address. All
  // earlier datagrams must have arrived, or else they would count as the newer one.
  const auto arrived = [&] { return server.datagrams().delivered; };
  ASSERT_TRUE(serveUntil(context, {&ann}, [&] { return arrived() == valve->sent; }));
  const std::uint64_t before = arrived();
  valve->up = false;
  const std::size_t lost = seen.size();
  ann.session().sendKey(df::Keyboard::RIGHTARROW, df::KEY_PRESSED, Clock::now());
  ASSERT_GT(seen.size(), lost);
  valve->up = true;
  ASSERT_TRUE(serveUntil(context, {&ann}, [&] { return ann.session().score() == 1 && arrived() > before; }));
  udp::socket attacker(context, udp::endpoint(asio::ip::address_v4::loopback(), 0));
  attacker.non_blocking(true);
  asio::error_code ignored;
  attacker.send_to(asio::buffer(seen[lost]), {asio::ip::address_v4::loopback(), server.port()}, 0, ignored);
  ASSERT_TRUE(hears(ann, 100));
  EXPECT_EQ(attacker.available(), 0u);
  EXPECT_EQ(scoreOf(server, ann.player()), 1) << "the key was not pressed twice";
  EXPECT_TRUE(settles(ann));
}

TEST_F(HostileTls, DatagramFloodDoesNotStopTheGame) {
  TestServer server(busyWorld(20), home.server());
  TestClient ann(context, server.port(), player("ann"));
  ASSERT_TRUE(settles(ann));
  const std::vector<std::string> genuine = seen;
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

TEST_F(HostileTls, HalfOpenConnectionsAreDropped) {
  using asio::ip::tcp;
  TestServer server(busyWorld(20), home.server());
  TestClient ann(context, server.port(), player("ann"));
  ASSERT_TRUE(settles(ann));
  struct HalfOpen {
    explicit HalfOpen(asio::io_context& c) : socket(c) {}
    tcp::socket socket;
    char byte = 0;
    bool over = false;
  };
  std::vector<std::unique_ptr<HalfOpen>> crowd;
  for (int i = 0; i < 30; ++i) {
    HalfOpen& one = *crowd.emplace_back(std::make_unique<HalfOpen>(context));
    one.socket.connect({asio::ip::address_v4::loopback(), server.port()});
    // Half of them are silent, the others send only the beginning of a ClientHello.
    if (i % 2 == 0) asio::write(one.socket, asio::buffer("\x16\x03\x01\x02\x00\x01", 6));
    one.socket.async_read_some(asio::buffer(&one.byte, 1), [&one](auto, std::size_t) { one.over = true; });
  }
  // Another player can join at this time.
  TestClient bob(context, server.port(), home.player("bob"));
  EXPECT_TRUE(serveUntil(context, {&ann, &bob}, [&] { return bob.joined(); }));
  EXPECT_TRUE(serveUntil(context, {&ann, &bob}, [&] {
    return std::ranges::all_of(crowd, [](const auto& one) { return one->over; });
  }));
  EXPECT_EQ(server.counters().connections, 2u) << "none of them got as far as a session";
  EXPECT_EQ(ann.session().state(), ClientSession::State::kPlaying);
}

}  // namespace
}  // namespace naiad::test
