// Many clients at once must not delay the tick: many players behind one address, floods, password guesses.
#include <gtest/gtest.h>

#include <algorithm>
#include <asio/ip/udp.hpp>
#include <atomic>
#include <set>
#include <thread>
#include <vector>

#include "LightClient.h"
#include "LoopbackFixture.h"
#include "RawClient.h"
#include "Valve.h"
#include "engine/world/Views.h"
#include "host/auth/PasswordHash.h"
#include "shared/values/SplitMix64.h"

namespace naiad::test {
namespace {

using asio::ip::udp;
using Clock = std::chrono::steady_clock;

using ManyClients = LoopbackFixture;

TEST_F(ManyClients, OneAddressMayHave64Players) {
  TestServer server(busyWorld(5), home.server());
  std::vector<std::unique_ptr<LightClient>> pupils;
  for (int i = 0; i < 64; ++i) {
    pupils.push_back(std::make_unique<LightClient>(context, server.port(), "127.1.1.1"));
    pupils.back()->join();
  }
  ASSERT_TRUE(serveUntil(context, {}, [&] {
    return std::ranges::none_of(
        pupils, [](const auto& pupil) { return pupil->state() == LightClient::State::kJoining; });
  }));
  std::set<std::string> names;
  for (const auto& pupil : pupils) names.insert(pupil->welcome().name());
  EXPECT_EQ(names.size(), 64u);
  EXPECT_EQ(server.counters().joined, 64u);
  EXPECT_EQ(server.counters().refused_address, 0u);
}

TEST_F(ManyClients, PlayersPerAddressAreLimited) {
  HostOptions options = fastOptions();
  options.grace = HostOptions().grace;
  options.max_players = 8;
  options.max_per_address = 2;
  TestServer server(busyWorld(5), options);
  const auto answerTo = [&](RawClient& client) {
    client.send(RawClient::hello("ann"));
    return client.receive().value_or(wire::ServerMessage());
  };
  auto first = std::make_unique<RawClient>(server.port());
  RawClient second(server.port()), third(server.port());
  EXPECT_TRUE(answerTo(*first).has_welcome());
  EXPECT_TRUE(answerTo(second).has_welcome());
  const wire::ServerMessage refusal = answerTo(third);
  EXPECT_EQ(refusal.refused().reason(), wire::Refused::FULL);
  EXPECT_EQ(refusal.refused().message(), "Too many players from your address (limit 2). Try again later.");
  EXPECT_EQ(server.counters().refused_address, 1u);
  wire::ClientMessage leave;
  leave.mutable_leave();
  first->send(leave);
  EXPECT_TRUE(first->waitForHangup());
  RawClient fourth(server.port());
  EXPECT_TRUE(answerTo(fourth).has_welcome());
}

TEST_F(ManyClients, ClaimedTerminalSizeDoesNotEnlargeTheView) {
  TestServer server(busyWorld(5), fastOptions());
  wire::ClientMessage hello = RawClient::hello("ann");
  hello.mutable_hello()->set_columns(4'000'000'000u);
  hello.mutable_hello()->set_rows(4'000'000'000u);
  RawClient client(server.port());
  client.send(hello);
  const auto answer = client.receive();
  ASSERT_TRUE(answer && answer->has_welcome());
  const auto window =
      server.inWorld([](df::World& w) { return std::pair(w.views().width(), w.views().height()); });
  EXPECT_LE(answer->welcome().view_width(), static_cast<unsigned>(window.first));
  EXPECT_LE(answer->welcome().view_height(), static_cast<unsigned>(window.second));
}

/// Comparing a wrong password takes as long as comparing the right one.
TEST_F(ManyClients, PasswordCheckDoesNotBlockTheTick) {
  HostOptions options = fastOptions();
  options.frame_micros = 1000;
  options.password = PasswordHash::of("the right one", {.memory_kib = 8 * 1024, .passes = 12}).text();
  TestServer server(busyWorld(5), options);
  const auto ticks = [&] { return server.counters().ticks; };
  wire::ClientMessage hello = RawClient::hello("eve");
  hello.mutable_hello()->set_password("a wrong one");
  RawClient eve(server.port());
  eve.send(hello);
  const std::uint64_t before = ticks();
  const auto answer = eve.receive();
  EXPECT_GE(ticks() - before, 10u) << "of a millisecond each, and the guess takes some fifty";
  ASSERT_TRUE(answer && answer->has_refused());
  EXPECT_EQ(answer->refused().reason(), wire::Refused::PASSWORD);
}

/// Keeps the newest datagram of a client, like an eavesdropper could.
class Overheard : public DatagramSocket {
 public:
  Overheard(std::unique_ptr<DatagramSocket> socket, std::string& newest)
      : m_socket(std::move(socket)), m_newest(newest) {}
  void start(OnPacket on_packet) override { m_socket->start(std::move(on_packet)); }
  void send(const Path& path, std::string_view packet) override {
    m_newest = packet;
    m_socket->send(path, packet);
  }
  void flush() override { m_socket->flush(); }
  void reopen() override { m_socket->reopen(); }
  Endpoint localEndpoint() const override { return m_socket->localEndpoint(); }

 private:
  std::unique_ptr<DatagramSocket> m_socket;
  std::string& m_newest;
};

TEST_F(ManyClients, SpoofedAddressesDoNotLockPlayersOut) {
  TestServer server(busyWorld(5), home.server());
  const auto valve = std::make_shared<Valve>();
  std::string overheard;
  ClientSetup setup = home.player("ann");
  setup.options.open_socket = [&, open = through(context, valve)](const Endpoint& endpoint) {
    return std::make_unique<Overheard>(open(endpoint), overheard);
  };
  TestClient ann(context, server.port(), setup);
  ASSERT_TRUE(settles(ann));

  // Sends forgeries from two hundred addresses, half of them with ann's id.
  std::atomic<bool> done = false;
  std::atomic<std::uint64_t> sent = 0;
  std::thread spoofer([&, port = server.port(), genuine = overheard] {
    asio::io_context own;
    std::vector<udp::socket> sockets;
    for (unsigned i = 0; i < 200; ++i) {
      const asio::ip::address_v4 from(0x7F010000u + 256 * (i % 20) + i + 1);
      sockets.emplace_back(own, udp::endpoint(from, 0));
    }
    SplitMix64 random(7);
    while (!done) {
      std::string forged = genuine;
      for (std::size_t k = random.below(2) == 0 ? 1 : 9; k < forged.size(); ++k)
        forged[k] = static_cast<char>(random.next());
      asio::error_code ignored;
      sockets[random.below(sockets.size())].send_to(asio::buffer(forged),
                                                    {asio::ip::address_v4::loopback(), port}, 0, ignored);
      ++sent;
    }
  });
  // Ann continues to play. Another player joins, gets datagrams, and moves to another port.
  const auto bobs = std::make_shared<Valve>();
  ClientSetup other = home.player("bob");
  other.options.open_socket = through(context, bobs);
  TestClient bob(context, server.port(), other);
  EXPECT_TRUE(serveUntil(context, {&ann, &bob}, [&] { return isOnDatagrams(bob); }));
  bobs->rebind();
  const auto heard = [&] {
    return std::pair(ann.session().counters().datagrams_in, bob.session().counters().datagrams_in);
  };
  const auto before = heard();
  EXPECT_TRUE(serveUntil(context, {&ann, &bob}, [&] {
    return heard().first > before.first + 50 && heard().second > before.second + 50;
  }));
  EXPECT_TRUE(serveUntil(context, {&ann, &bob}, [&] { return sent > 5'000; }));
  done = true;
  spoofer.join();
  EXPECT_EQ(ann.session().state(), ClientSession::State::kPlaying);
  EXPECT_EQ(server.counters().detached, 0u);
  const DatagramDemuxCounters gate = server.datagrams();
  EXPECT_GT(gate.unknown_id, 500u);
  EXPECT_GT(gate.unvalidated_session_flood, 500u) << "most of them met no cryptography";
}

}  // namespace
}  // namespace naiad::test
