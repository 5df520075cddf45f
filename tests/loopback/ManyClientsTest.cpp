// Many clients at once must not delay the tick: many players behind one address, floods, password guesses.
#include <gtest/gtest.h>

#include <asio/ip/udp.hpp>
#include <atomic>
#include <thread>
#include <vector>

#include "LoopbackFixture.h"
#include "RawClient.h"
#include "host/auth/PasswordHash.h"
#include "shared/values/SplitMix64.h"

namespace naiad::test {
namespace {

using asio::ip::udp;

using ManyClients = LoopbackFixture;

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

TEST_F(ManyClients, SpoofedAddressesDoNotLockPlayersOut) {
  TestServer server(busyWorld(5), home.server());
  TestClient ann(context, server.port(), playerWithValve("ann"));
  ASSERT_TRUE(settles(ann));

  // Sends forgeries from two hundred addresses, half of them with ann's id.
  std::atomic<bool> done = false;
  std::atomic<std::uint64_t> sent = 0;
  std::thread spoofer([&, port = server.port(), genuine = valve->seen.back()] {
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
