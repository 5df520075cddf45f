// Connections that a TLS listener accepts, refuses and survives.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <vector>

#include "TlsFixture.h"

namespace naiad::test {
namespace {

using namespace std::chrono_literals;
using namespace std::string_literals;

struct TlsListenerTest : TlsFixture {
  /// No handshake is late, unless the test sets another timeout.
  TlsListenerTest() { tls.handshake_timeout = 1h; }

  /// Sends frames both ways over the newest pair of channels.
  void expectConversation() {
    ASSERT_TRUE(channel) << error;
    Recorder here, there;
    channel->start(here.callbacks());
    accepted.back()->start(there.callbacks());
    channel->send("up");
    accepted.back()->send(std::string(kMaxServerFrame, 'd'));
    EXPECT_TRUE(runUntil(context, [&] { return !here.frames.empty() && !there.frames.empty(); }));
    EXPECT_EQ(there.frames, std::vector{"up"s});
    EXPECT_EQ(here.frames, std::vector{std::string(kMaxServerFrame, 'd')});
    channel.reset();
    accepted.pop_back();
  }

  /// Waits until `socket` has received a byte or its end. Returns true if it is a byte.
  bool isAnswered(tcp::socket& socket) {
    std::error_code failure;
    std::array<char, 1> answer;
    socket.non_blocking(true);
    EXPECT_TRUE(runUntil(context, [&] {
      socket.read_some(asio::buffer(answer), failure);
      return failure != asio::error::would_block;
    }));
    return !failure;
  }

  /// Opens 16 connections from four addresses of one network. They begin their ClientHellos, and complete
  /// them when they have all places.
  std::vector<tcp::socket> finishHellosTogether() {
    const std::string hello = RawTls().advance();
    std::vector<tcp::socket> flood;
    for (int i = 0; i < 16; ++i) {
      flood.push_back(knockFrom("127.1.1." + std::to_string(1 + i % 4)));
      asio::write(flood.back(), asio::buffer(hello, hello.size() - 1));
    }
    EXPECT_TRUE(runUntil(context, [&] { return listener->halfOpen() == 16; }));
    for (tcp::socket& one : flood) asio::write(one, asio::buffer(&hello.back(), 1));
    for (tcp::socket& one : flood)
      EXPECT_TRUE(runUntil(context, [&] { return one.available() > 0 || isOver(one); }));
    return flood;
  }
};

/// Allows this many handshakes per prefix.
std::function<bool(const AddressPrefix&)> atMost(int times, std::map<AddressPrefix, int>& asked) {
  return [times, &asked](const AddressPrefix& prefix) { return ++asked[prefix] <= times; };
}

TEST_F(TlsListenerTest, FramesPassBothWays) {
  for (const auto& [on, to] :
       {std::pair{"127.0.0.1", "127.0.0.1"}, {"0.0.0.0", "127.0.0.1"}, {"::1", "::1"}}) {
    if (to == "::1"s && !haveIPv6Loopback()) GTEST_SKIP() << "no IPv6 loopback on this machine";
    SCOPED_TRACE(on);
    listen(on);
    join(to);
    expectConversation();
    EXPECT_EQ(counters().handshakes, 1u);
    EXPECT_EQ(listener->halfOpen(), 0u);
  }
}

TEST_F(TlsListenerTest, UnspecifiedIPv6AddressTakesBothFamilies) {
  if (!haveIPv6Loopback()) GTEST_SKIP() << "no IPv6 loopback on this machine";
  listen("::");
  join("::1");
  EXPECT_EQ(accepted.back()->peerAddress().substr(0, 6), "[::1]:");
  expectConversation();
  join("127.0.0.1");
  EXPECT_EQ(accepted.back()->peerAddress().substr(0, 10), "127.0.0.1:");
  expectConversation();
}

TEST_F(TlsListenerTest, RefusesTls12) {
  listen();
  tcp::socket socket = knock();
  RawTls client([](SSL_CTX* c) { SSL_CTX_set_max_proto_version(c, TLS1_2_VERSION); });
  client.shakeHands(context, socket);
  EXPECT_FALSE(client.done());
  EXPECT_TRUE(runUntil(context, [&] { return counters().handshakes_failed == 1; }));
  EXPECT_TRUE(accepted.empty());
}

TEST_F(TlsListenerTest, RefusesWrongAndMissingAlpn) {
  listen();
  for (const std::string alpn : {"", "h2", "naiad/2", "naiad/11", "naiad/"}) {
    const std::uint64_t before = counters().handshakes_failed;
    tcp::socket socket = knock();
    RawTls client([&](SSL_CTX* c) { offerAlpn(c, alpn); });
    client.shakeHands(context, socket);
    EXPECT_FALSE(client.done()) << alpn;
    EXPECT_TRUE(runUntil(context, [&] { return counters().handshakes_failed == before + 1; })) << alpn;
  }
  EXPECT_TRUE(accepted.empty());
  EXPECT_EQ(listener->halfOpen(), 0u);
}

TEST_F(TlsListenerTest, RefusesNonTlsBytes) {
  listen();
  for (const std::string& words :
       {"\x05\0hello"s, "GET / HTTP/1.1\r\n\r\n"s, std::string(70'000, '\xff'), "\x16\x03"s}) {
    const std::uint64_t before = counters().handshakes_failed;
    tcp::socket socket = knock();
    std::error_code ignored;
    asio::write(socket, asio::buffer(words), ignored);
    socket.shutdown(tcp::socket::shutdown_send, ignored);
    EXPECT_TRUE(runUntil(context, [&] { return counters().handshakes_failed == before + 1; }));
  }
  EXPECT_TRUE(accepted.empty());
  EXPECT_EQ(listener->halfOpen(), 0u);
}

TEST_F(TlsListenerTest, RefusesAnOversizedHelloAtItsHeader) {
  listen();
  tcp::socket socket = knock();
  asio::write(socket,
              asio::buffer("\x16\x03\x01\x40\x00\x01\x02\x00\x00"s));  // announces 131,072 bytes
  EXPECT_TRUE(runUntil(context, [&] { return counters().handshakes_failed == 1; }));
}

TEST_F(TlsListenerTest, SendsNoSessionTickets) {
  listen();
  tcp::socket socket = knock();
  RawTls client;
  client.shakeHands(context, socket);
  ASSERT_TRUE(runUntil(context, [&] { return accepted.size() == 1; }));
  accepted[0]->send("after the handshake");  // session tickets would have been sent before this frame
  char byte = 0;
  EXPECT_TRUE(runUntil(context, [&] { return client.read(socket, &byte, 1) == 1; }));
  EXPECT_EQ(SSL_SESSION_is_resumable(SSL_get0_session(client.ssl())), 0);
}

TEST_F(TlsListenerTest, ByteByByteHandshakeIsCountedOnce) {
  std::map<AddressPrefix, int> asked;
  tls.try_handshake = atMost(1, asked);
  listen();
  tcp::socket socket = knock();
  socket.set_option(tcp::no_delay(true));
  socket.non_blocking(true);
  RawTls client;
  for (int flights = 0; !client.done() && flights < 5; ++flights) {
    const std::string flight = client.advance();
    for (const char& byte : flight) {
      asio::write(socket, asio::buffer(&byte, 1));
      runReady(context);
    }
    if (client.done()) break;
    std::error_code ignored;
    ASSERT_TRUE(runUntil(context, [&] { return client.receive(socket, ignored) > 0; }));
  }
  EXPECT_TRUE(client.done());
  EXPECT_TRUE(runUntil(context, [&] { return accepted.size() == 1; }));
  EXPECT_EQ(asked.begin()->second, 1);
}

TEST_F(TlsListenerTest, HandshakeThatStopsHalfwayIsEndedByTheDeadline) {
  tls.handshake_timeout = 50ms;
  listen();
  tcp::socket socket = knock();
  RawTls client;
  asio::write(socket, asio::buffer(client.advance().substr(0, 100)));
  EXPECT_TRUE(runUntil(context, [&] { return counters().handshakes_late == 1; }));
  EXPECT_EQ(listener->halfOpen(), 0u);
  EXPECT_TRUE(runUntil(context, [&] { return isOver(socket); }));
}

TEST_F(TlsListenerTest, IdleConnectionsPerPrefixAreLimited) {
  tls.max_half_open_per_prefix = 5;
  listen();
  auto flood = knockTimes(20);
  EXPECT_TRUE(runUntil(context, [&] { return counters().half_open_ended == 15; }));
  EXPECT_EQ(listener->halfOpen(), 5u);
  for (std::size_t i = 0; i < flood.size(); ++i) EXPECT_EQ(isOver(flood[i]), i < 15) << "the oldest: " << i;
  join();         // succeeds although its prefix is crowded
  flood.clear();  // they disconnect and free their slots
  EXPECT_TRUE(runUntil(context, [&] { return listener->halfOpen() == 0; }));
  EXPECT_EQ(counters().refused_from_prefix, 0u);
}

TEST_F(TlsListenerTest, ClassOf64MayConnectFromOneAddress) {
  listen();
  auto pupils = knockTimes(64);
  EXPECT_TRUE(runUntil(context, [&] { return listener->halfOpen() == 64; }));
  EXPECT_EQ(counters().half_open_ended, 0u);
  pupils.push_back(knock());
  EXPECT_TRUE(runUntil(context, [&] { return counters().half_open_ended == 1; }));
}

TEST_F(TlsListenerTest, TotalIdleConnectionsAreLimitedAndTimeOut) {
  tls.max_half_open = 8;
  tls.handshake_timeout = 100ms;
  listen();
  auto flood = knockTimes(20);
  EXPECT_TRUE(
      runUntil(context, [&] { return counters().handshakes_late + counters().half_open_ended == 20; }));
  EXPECT_GE(counters().handshakes_late, 8u);
  EXPECT_GT(counters().half_open_ended, 0u);
  join();
}

TEST_F(TlsListenerTest, HandshakeWithACompleteHelloIsNotEvicted) {
  tls.max_half_open_per_prefix = 4;
  listen();
  tcp::socket slow = knock();
  RawTls client;
  asio::write(slow, asio::buffer(client.advance()));
  ASSERT_TRUE(runUntil(context, [&] { return slow.available() > 0; })) << "the server's answer";
  auto flood = knockTimes(20);
  EXPECT_TRUE(runUntil(context, [&] { return counters().half_open_ended == 17; }));
  client.shakeHands(context, slow);
  EXPECT_TRUE(client.done());
  EXPECT_TRUE(runUntil(context, [&] { return accepted.size() == 1; }));
}

TEST_F(TlsListenerTest, ReceivedButUnreadHelloPreventsEviction) {
  tls.max_half_open_per_prefix = 1;
  listen();
  tcp::socket slow = knock();
  ASSERT_TRUE(runUntil(context, [&] { return listener->halfOpen() == 1; }));
  tcp::socket next = knock();  // the listener accepts this one before it reads the hello
  RawTls client;
  asio::write(slow, asio::buffer(client.advance()));
  client.shakeHands(context, slow);
  EXPECT_TRUE(client.done());
  EXPECT_EQ(counters().half_open_ended, 0u);
}

TEST_F(TlsListenerTest, SimultaneousHellosLeaveFreeSlots) {
  for (const bool is_known : {false, true}) {
    (is_known ? tls.max_half_open_known : tls.max_half_open) = 16;
    tls.is_known = [is_known](const AddressPrefix&) { return is_known; };
    listen();
    const auto flood = finishHellosTogether();
    if (!is_known) {
      EXPECT_EQ(listener->halfOpen(), 8u);
    }
    EXPECT_EQ(counters().refused_from_prefix, 8u) << is_known;
    join();
    expectConversation();
  }
}

TEST_F(TlsListenerTest, SlotsAreReservedForKnownPrefixes) {
  tls.max_half_open = 4;
  const AddressPrefix own = AddressPrefix::of(asio::ip::make_address("127.0.0.1"));
  tls.is_known = [own](const AddressPrefix& prefix) { return prefix == own; };
  listen();
  const std::string hello = RawTls().advance();
  std::vector<tcp::socket> flood;
  for (int i = 0; i < 12; ++i) {
    flood.push_back(knockFrom("127.1." + std::to_string(i) + ".1"));
    asio::write(flood.back(), asio::buffer(hello));
  }
  ASSERT_TRUE(
      runUntil(context, [&] { return counters().refused_half_open + counters().refused_from_prefix == 8; }));
  EXPECT_EQ(listener->halfOpen(), 4u);
  join();
  expectConversation();
}

TEST_F(TlsListenerTest, HandshakeFloodFromOneAddressIsDroppedEarly) {
  std::map<AddressPrefix, int> asked;
  tls.try_handshake = atMost(3, asked);
  listen();
  const std::string hello = RawTls().advance();
  for (std::size_t i = 0; i < 40; ++i) {
    tcp::socket one = knockFrom("127.1.1.1");
    asio::write(one, asio::buffer(hello));
    EXPECT_EQ(isAnswered(one), i < 3) << i;
    if (i % 20 == 19) join();
  }
  EXPECT_EQ(counters().refused_too_often, 37u);
  EXPECT_EQ(counters().handshakes, 2u);
  EXPECT_TRUE(runUntil(context, [&] { return listener->halfOpen() == 0; }));
}

TEST_F(TlsListenerTest, ConnectionWithoutHandshakeBudgetIsDroppedAtOnce) {
  const AddressPrefix limited = AddressPrefix::of(asio::ip::make_address("127.1.1.1"));
  tls.can_handshake = [limited](const AddressPrefix& prefix) { return prefix != limited; };
  listen();
  std::vector<tcp::socket> flood;
  for (int i = 0; i < 20; ++i) flood.push_back(knockFrom("127.1.1.1"));
  EXPECT_TRUE(runUntil(context, [&] { return counters().refused_too_often == 20; }));
  EXPECT_EQ(listener->halfOpen(), 0u);
  EXPECT_TRUE(std::all_of(flood.begin(), flood.end(), isOver));
  join();
  expectConversation();
}

TEST_F(TlsListenerTest, BannedAddressGetsNoByte) {
  const auto banned = asio::ip::make_address("127.1.1.1");
  tls.is_banned = [banned](const asio::ip::address& address) { return address == banned; };
  listen();
  const std::string hello = RawTls().advance();
  for (int i = 0; i < 20; ++i) {
    tcp::socket one = knockFrom("127.1.1.1");
    std::error_code failure;
    asio::write(one, asio::buffer(hello), failure);  // may fail if the connection has ended already
    EXPECT_FALSE(isAnswered(one));
  }
  EXPECT_EQ(counters().refused_banned, 20u);
  EXPECT_EQ(listener->halfOpen(), 0u);
  join();
  expectConversation();
}

TEST_F(TlsListenerTest, OnlyAdmittedHellosCountAsHandshakes) {
  std::map<AddressPrefix, int> asked;
  tls.try_handshake = atMost(1, asked);
  tls.max_half_open_per_prefix = 1;
  listen();
  const std::string hello = RawTls().advance();
  auto flood = knockTimes(20);
  for (int i = 0; i < 2; ++i) {
    flood.push_back(knockFrom("127.1.1.1"));
    asio::write(flood.back(), asio::buffer(hello));
    ASSERT_TRUE(runUntil(context, [&] { return flood.back().available() > 0 || isOver(flood.back()); }));
  }
  EXPECT_EQ(counters().refused_from_prefix, 1u);
  EXPECT_EQ(counters().refused_too_often, 0u);
  join();
  expectConversation();
}

TEST_F(TlsListenerTest, HandshakeTimeoutsShrinkAboveHalfTheLimit) {
  tls.max_half_open = 8;
  tls.handshake_timeout = 2s;
  listen();
  std::vector<tcp::socket> flood;
  for (std::size_t i = 1; i <= 8; ++i) {
    flood.push_back(knockFrom("127." + std::to_string(i) + ".1.1"));
    ASSERT_TRUE(runUntil(context, [&] { return listener->halfOpen() == i; }));
  }
  RawTls client;
  asio::write(flood[7], asio::buffer(client.advance()));
  const auto endsAt = [&](std::size_t count) {
    return runUntil(context, [&] { return counters().handshakes_late == count; });
  };
  const auto over = [&](std::size_t first, std::size_t last) {
    return std::all_of(flood.begin() + static_cast<std::ptrdiff_t>(first),
                       flood.begin() + static_cast<std::ptrdiff_t>(last), isOver);
  };
  ASSERT_TRUE(endsAt(3));
  EXPECT_TRUE(over(4, 7)) << "the silent ones of the second half, after 0.5 s";
  ASSERT_TRUE(endsAt(4));
  EXPECT_TRUE(over(7, 8)) << "the one that has said hello, after 1 s";
  ASSERT_TRUE(endsAt(8));
}

TEST_F(TlsListenerTest, SilentConnectionIsDeferredByTheKernel) {
  tls.defer_accept = TlsListenerOptions().defer_accept;
  ASSERT_GT(tls.defer_accept.count(), 0) << "as shipped";
  listen();
  tcp::socket silent = knock();
  join();  // connected later, but accepted first because it sends data
  EXPECT_EQ(listener->halfOpen(), 0u);
  EXPECT_TRUE(runUntil(context, [&] { return listener->halfOpen() == 1; })) << "but it is not forgotten";
}

TEST_F(TlsListenerTest, ClosingTheListenerAbortsHandshakes) {
  listen();
  tcp::socket socket = knock();
  EXPECT_TRUE(runUntil(context, [&] { return listener->halfOpen() == 1; }));
  listener.reset();
  EXPECT_TRUE(runUntil(context, [&] { return isOver(socket); }));
  EXPECT_TRUE(runUntil(context, [&] { return context.stopped(); }));  // no operation is pending
}

TEST_F(TlsListenerTest, MayBeDestroyedInItsCallback) {
  tls.context = testServerContext();
  int made = 0;
  listener = std::make_unique<TcpListener>(
      context, "127.0.0.1", 0,
      [&](auto) {
        listener.reset();
        ++made;
      },
      TcpOptions{}, tls);
  connector.connect("127.0.0.1", listener->port(), 10s, done());
  EXPECT_TRUE(runUntil(context, [&] { return made == 1; }));
}

}  // namespace
}  // namespace naiad::test
