#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <memory>
#include <set>
#include <string>
#include <vector>

#include "shared/net/datagram/UdpSocket.h"
#include "tests/shared/net/Loopback.h"
#include "tests/support/Text.h"

namespace naiad::test {
namespace {

struct Received {
  Path path;
  std::string packet;
};

struct Peer {
  Peer(asio::io_context& context, const UdpOptions& options) : socket(context, options) {
    socket.start([this](const Path& path, std::string_view packet) {
      received.push_back({path, std::string(packet)});
    });
  }
  Endpoint at(const char* address) const { return *makeEndpoint(address, socket.localEndpoint().port); }
  void send(const Endpoint& to, std::string_view packet) {
    socket.send({.local = {}, .remote = to}, packet);
    socket.flush();
  }

  /// Sends to the source of the newest packet.
  void reply(std::string_view packet) {
    socket.send(received.back().path, packet);
    socket.flush();
  }

  UdpSocket socket;
  std::vector<Received> received;
};

bool arrive(asio::io_context& context, const Peer& peer, std::size_t count) {
  return runUntil(context, [&] { return peer.received.size() >= count; });
}

struct UdpSocketTest : testing::Test {
  asio::io_context context;
};
using UdpSocketOnIPv6 = UdpSocketTest;

TEST_F(UdpSocketTest, RepliesLeaveFromTheReceivingAddress) {
  for (const bool is_ipv6 : {false, true}) {
    if (is_ipv6 && !haveIPv6Loopback()) GTEST_SKIP() << "no IPv6 here";
    const char* const own = is_ipv6 ? "::1" : "127.0.0.1";
    Peer server(context, {.address = is_ipv6 ? "::" : "0.0.0.0"}), client(context, {.address = own});
    for (const char* address :
         is_ipv6 ? std::vector{"::1"} : std::vector{"127.0.0.2", "127.0.0.1", "127.3.4.5"}) {
      client.received.clear();
      server.received.clear();
      client.send(server.at(address), "x");
      ASSERT_TRUE(arrive(context, server, 1));
      EXPECT_EQ(server.received[0].path, (Path{server.at(address), client.at(own)}));
      server.reply("y");
      ASSERT_TRUE(arrive(context, client, 1));
      EXPECT_EQ(client.received[0].packet, "y");
      EXPECT_EQ(client.received[0].path.remote, server.at(address));
    }
    EXPECT_EQ(server.socket.counters().received, is_ipv6 ? 1u : 3u);
    EXPECT_EQ(server.socket.counters().sent, server.socket.counters().received);
  }
}

TEST_F(UdpSocketOnIPv6, DualStackServesBothFamilies) {
  if (!haveIPv6Loopback()) GTEST_SKIP() << "no IPv6 here";
  Peer server(context, {.address = "::", .v6_only = false});
  Peer four(context, {.address = "127.0.0.1"}), six(context, {.address = "::1"});
  four.send(server.at("127.0.0.9"), "four");
  six.send(server.at("::1"), "six");
  ASSERT_TRUE(arrive(context, server, 2));
  for (const Received& received : server.received) server.socket.send(received.path, received.packet);
  server.socket.flush();
  ASSERT_TRUE(arrive(context, four, 1));
  ASSERT_TRUE(arrive(context, six, 1));
  EXPECT_EQ(four.received[0].packet, "four");
  EXPECT_EQ(four.received[0].path.remote, server.at("127.0.0.9"));
  EXPECT_EQ(six.received[0].packet, "six");
}

TEST_F(UdpSocketOnIPv6, SingleStackLeavesTheIPv4PortFree) {
  if (!haveIPv6Loopback()) GTEST_SKIP() << "no IPv6 here";
  Peer six(context, {.address = "::", .v6_only = true});
  Peer four(context, {.address = "0.0.0.0", .port = six.socket.localEndpoint().port});
  Peer client(context, {.address = "127.0.0.1"});
  client.send(four.at("127.0.0.1"), "x");
  ASSERT_TRUE(arrive(context, four, 1));
  EXPECT_TRUE(six.received.empty());
}

TEST_F(UdpSocketTest, OneBurstGoesToManyPeers) {
  Peer server(context, {.address = "0.0.0.0"});
  std::vector<std::unique_ptr<Peer>> peers;
  for (int i = 0; i < 30; ++i) peers.push_back(std::make_unique<Peer>(context, UdpOptions{}));
  for (int i = 0; i < 3000; ++i) {
    const Peer& peer = *peers[static_cast<std::size_t>(i % 30)];
    const std::string local = "127.0.0." + std::to_string(2 + i % 50);
    server.socket.send({server.at(local.c_str()), peer.at("127.0.0.1")}, std::to_string(i));
  }
  server.socket.flush();
  for (const auto& peer : peers) {
    ASSERT_TRUE(arrive(context, *peer, 100));
    for (const Received& received : peer->received) {
      const int number = std::stoi(received.packet);
      const std::string local = "127.0.0." + std::to_string(2 + number % 50);
      ASSERT_EQ(received.path.remote, server.at(local.c_str()));
    }
  }
}

TEST_F(UdpSocketTest, NothingLeavesBeforeTheFlushOrAFullBatch) {
  Peer server(context, {}), client(context, {});
  for (std::size_t i = 1; i < kUdpBatch; ++i) client.socket.send({{}, server.at("127.0.0.1")}, "x");
  EXPECT_EQ(client.socket.counters().sent, 0u);
  client.socket.send({{}, server.at("127.0.0.1")}, "x");
  EXPECT_EQ(client.socket.counters().sent, kUdpBatch);
  client.socket.send({{}, server.at("127.0.0.1")}, "x");
  EXPECT_EQ(client.socket.counters().sent, kUdpBatch);
  client.socket.flush();
  ASSERT_TRUE(arrive(context, server, kUdpBatch + 1));
}

TEST_F(UdpSocketTest, PacketsBuiltInPlaceArriveLikeCopies) {
  Peer server(context, {}), client(context, {});
  const Path path{{}, server.at("127.0.0.1")};
  for (std::size_t i = 0; i < 2 * kUdpBatch; ++i) {
    const std::string packet = "packet " + std::to_string(i);
    char* const memory = client.socket.nextPacket();
    const bool in_place = i % 3 != 0;
    if (in_place) packet.copy(memory, packet.size());
    client.socket.send(path, in_place ? std::string_view(memory, packet.size()) : packet);
  }
  ASSERT_TRUE(arrive(context, server, 2 * kUdpBatch));
  for (std::size_t i = 0; i < 2 * kUdpBatch; ++i)
    EXPECT_EQ(server.received[i].packet, "packet " + std::to_string(i));
}

TEST_F(UdpSocketTest, OneWakeUpReadsALimitedNumberOfPackets) {
  Peer server(context, {}), client(context, {});
  for (int i = 0; i < 400; ++i) client.socket.send({{}, server.at("127.0.0.1")}, "x");
  client.socket.flush();
  while (server.received.empty()) context.run_one_for(std::chrono::seconds(30));
  EXPECT_EQ(server.received.size(), 256u);
  ASSERT_TRUE(arrive(context, server, 400));
}

TEST_F(UdpSocketTest, ClosedPortIsNotAnError) {
  const std::uint16_t free_port = Peer(context, {}).socket.localEndpoint().port;
  Peer server(context, {}), client(context, {});
  for (int i = 0; i < 10; ++i) client.send(*makeEndpoint("127.0.0.1", free_port), "x");
  runReady(context);
  client.send(server.at("127.0.0.1"), "still works");
  ASSERT_TRUE(arrive(context, server, 1));
  EXPECT_EQ(client.socket.counters().sent + client.socket.counters().send_errors, 11u);
}

TEST_F(UdpSocketTest, UnsendablePacketsAreCountedAndDelayNothing) {
  Peer server(context, {}), client(context, {});
  client.socket.send({{}, *makeEndpoint("::1", 9)}, "another family");
  client.socket.send({{}, server.at("127.0.0.1")}, "one");
  client.socket.send({*makeEndpoint("192.0.2.77", 1), server.at("127.0.0.1")},
                     "from an address that is not ours");
  client.socket.send({{}, server.at("127.0.0.1")}, "two");
  client.socket.flush();
  ASSERT_TRUE(arrive(context, server, 2));
  EXPECT_EQ(server.received[1].packet, "two");
  EXPECT_EQ(client.socket.counters().send_errors, 2u);
  EXPECT_EQ(client.socket.counters().sent, 2u);
}

TEST_F(UdpSocketTest, PayloadSizeLimitsAreEnforced) {
  Peer server(context, {}), client(context, {});
  const Path path{{}, server.at("127.0.0.1")};
  EXPECT_THROW(client.socket.send(path, ""), std::length_error);
  EXPECT_THROW(client.socket.send(path, std::string(1201, 'x')), std::length_error);
  client.socket.send(path, std::string(1200, 'x'));
  client.socket.flush();
  ASSERT_TRUE(arrive(context, server, 1));
  EXPECT_EQ(server.received[0].packet, std::string(1200, 'x'));
}

/// Sends with a plain socket, for packets that UdpSocket would not send.
void sendRaw(const Endpoint& to, std::string_view packet) {
  const int descriptor = ::socket(AF_INET, SOCK_DGRAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(to.port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  ASSERT_EQ(::sendto(descriptor, packet.data(), packet.size(), 0, reinterpret_cast<sockaddr*>(&address),
                     sizeof address),
            static_cast<ssize_t>(packet.size()));
  ::close(descriptor);
}

TEST_F(UdpSocketTest, OversizedPacketsAreCountedAndDropped) {
  Peer server(context, {});
  sendRaw(server.at("127.0.0.1"), std::string(1201, 'x'));
  sendRaw(server.at("127.0.0.1"), std::string(9000, 'x'));
  sendRaw(server.at("127.0.0.1"), "");
  sendRaw(server.at("127.0.0.1"), "fine");
  ASSERT_TRUE(arrive(context, server, 2));
  EXPECT_EQ(server.received[0].packet, "");
  EXPECT_EQ(server.received[1].packet, "fine");
  EXPECT_EQ(server.socket.counters().too_large, 2u);
}

TEST_F(UdpSocketTest, ReopenedSocketUsesAnotherPort) {
  Peer server(context, {}), client(context, {});
  std::set<std::uint16_t> ports;
  for (std::size_t i = 0; i < 5; ++i) {
    if (i > 0) client.socket.reopen();
    client.send(server.at("127.0.0.1"), "x");
    ASSERT_TRUE(arrive(context, server, i + 1));
    EXPECT_EQ(server.received[i].path.remote, client.at("127.0.0.1"));
    ports.insert(server.received[i].path.remote.port);
    server.reply("y");
    ASSERT_TRUE(arrive(context, client, i + 1));
  }
  EXPECT_GT(ports.size(), 1u);
}

TEST_F(UdpSocketTest, MayBeReopenedOrDestroyedInItsCallback) {
  auto server = std::make_unique<UdpSocket>(context, UdpOptions{});
  Peer client(context, {});
  int calls = 0;
  server->start([&, marker = std::string(100, 'm')](const Path&, std::string_view packet) {
    calls += marker.size() == 100;
    packet == "reopen" ? server->reopen() : server.reset();
  });
  const auto send = [&](std::string_view packet) {
    for (int i = 0; i < 3; ++i) client.socket.send({{}, server->localEndpoint()}, packet);
    client.socket.flush();
  };
  send("reopen");
  ASSERT_TRUE(runUntil(context, [&] { return calls == 1; }));
  send("end");
  ASSERT_TRUE(runUntil(context, [&] { return calls == 2; }));
  runReady(context);
  EXPECT_EQ(calls, 2);
  EXPECT_EQ(server, nullptr);
}

TEST_F(UdpSocketTest, PortInUseGivesAClearMessage) {
  Peer first(context, {});
  const auto bindAgain = [&] { UdpSocket(context, {.port = first.socket.localEndpoint().port}); };
  EXPECT_EQ(codeOf<ListenError>(bindAgain), std::errc::address_in_use);
  EXPECT_TRUE(has(errorOf<ListenError>(bindAgain), "is in use by another program."));
}

TEST_F(UdpSocketTest, BadAddressesThrowAListenError) {
  for (const char* address : {"localhost", "", "192.0.2.77"})
    EXPECT_THROW(UdpSocket(context, {.address = address}), ListenError) << address;
}

/// Returns an option of the socket that is bound to `local`.
int optionOf(const Endpoint& local, int level, int option) {
  for (int descriptor = 0; descriptor < 1024; ++descriptor) {
    int type = 0, value = -1;
    socklen_t size = sizeof type;
    if (::getsockopt(descriptor, SOL_SOCKET, SO_TYPE, &type, &size) != 0 || type != SOCK_DGRAM) continue;
    sockaddr_in6 address{};  // both families have the port in one place
    size = sizeof address;
    if (::getsockname(descriptor, reinterpret_cast<sockaddr*>(&address), &size) != 0) continue;
    if (ntohs(address.sin6_port) != local.port) continue;
    size = sizeof value;
    return ::getsockopt(descriptor, level, option, &value, &size) == 0 ? value : -1;
  }
  return -1;
}

TEST_F(UdpSocketTest, PacketsAreNeverFragmented) {
  Peer four(context, {});
  EXPECT_EQ(optionOf(four.socket.localEndpoint(), IPPROTO_IP, IP_MTU_DISCOVER), IP_PMTUDISC_PROBE);
  four.socket.reopen();
  EXPECT_EQ(optionOf(four.socket.localEndpoint(), IPPROTO_IP, IP_MTU_DISCOVER), IP_PMTUDISC_PROBE);
  if (!haveIPv6Loopback()) return;
  Peer six(context, {.address = "::", .v6_only = false});
  EXPECT_EQ(optionOf(six.socket.localEndpoint(), IPPROTO_IPV6, IPV6_MTU_DISCOVER), IPV6_PMTUDISC_PROBE);
  EXPECT_EQ(optionOf(six.socket.localEndpoint(), IPPROTO_IPV6, IPV6_DONTFRAG), 1);
  EXPECT_EQ(optionOf(six.socket.localEndpoint(), IPPROTO_IP, IP_MTU_DISCOVER), IP_PMTUDISC_PROBE);
}

}  // namespace
}  // namespace naiad::test
