#include <gtest/gtest.h>

#include <vector>

#include "shared/net/stream/TcpListener.h"
#include "tests/shared/net/Loopback.h"
#include "tests/support/Text.h"

namespace naiad::test {
namespace {

struct TcpListenerTest : testing::Test {
  TcpListener::OnChannel keep() {
    return [this](std::unique_ptr<ReliableChannel> channel) { channels.push_back(std::move(channel)); };
  }
  tcp::socket connectTo(const TcpListener& listener, const std::string& address = "127.0.0.1") {
    tcp::socket socket(context);
    socket.connect({asio::ip::make_address(address), listener.port()});
    return socket;
  }

  asio::io_context context;
  std::vector<std::unique_ptr<ReliableChannel>> channels;
};

TEST_F(TcpListenerTest, PortZeroTakesAFreePort) {
  TcpListener first(context, "127.0.0.1", 0, keep());
  TcpListener second(context, "127.0.0.1", 0, keep());
  EXPECT_NE(first.port(), 0);
  EXPECT_NE(first.port(), second.port());
  EXPECT_EQ(first.address(), "127.0.0.1:" + std::to_string(first.port()));
}

TEST_F(TcpListenerTest, GivesAChannelForEachConnection) {
  TcpListener listener(context, "127.0.0.1", 0, keep());
  std::vector<tcp::socket> clients;
  for (int i = 0; i < 20; ++i) clients.push_back(connectTo(listener));
  EXPECT_TRUE(runUntil(context, [&] { return channels.size() == 20; }));
  for (std::size_t i = 0; i < channels.size(); ++i)
    EXPECT_EQ(channels[i]->peerAddress(), "127.0.0.1:" + std::to_string(clients[i].local_endpoint().port()));
  EXPECT_EQ(listener.failedAccepts(), 0u);
}

TEST_F(TcpListenerTest, PortInUseGivesAClearMessage) {
  TcpListener first(context, "127.0.0.1", 0, keep());
  const auto listenAgain = [&] { TcpListener(context, "127.0.0.1", first.port(), keep()); };
  EXPECT_EQ(codeOf<ListenError>(listenAgain), std::errc::address_in_use);
  EXPECT_EQ(errorOf<ListenError>(listenAgain), "Cannot listen: port " + std::to_string(first.port()) +
                                                   " on 127.0.0.1 is in use by another program.");
}

TEST_F(TcpListenerTest, AddressesThatAreNotLoopbackAreRefused) {
  for (const std::string address : {"0.0.0.0", "::", "192.0.2.1", "localhost", ""}) {
    const auto listen = [&] { TcpListener(context, address, 0, keep()); };
    EXPECT_EQ(codeOf<ListenError>(listen), std::errc::invalid_argument) << address;
    EXPECT_TRUE(has(errorOf<ListenError>(listen), address));
  }
}

TEST_F(TcpListenerTest, PortCanBeReusedRightAfterItsConnectionsEnd) {
  auto listener = std::make_unique<TcpListener>(context, "127.0.0.1", 0, keep());
  const std::uint16_t port = listener->port();
  tcp::socket client = connectTo(*listener);
  ASSERT_TRUE(runUntil(context, [&] { return channels.size() == 1; }));
  channels.clear();  // this side closes first, so its port stays in TIME_WAIT
  client.close();
  listener.reset();
  EXPECT_NO_THROW(TcpListener(context, "127.0.0.1", port, keep()));
}

TEST_F(TcpListenerTest, AClosedListenerAcceptsNoConnection) {
  TcpListener listener(context, "127.0.0.1", 0, keep());
  listener.close();
  EXPECT_THROW(connectTo(listener), std::system_error);
  runReady(context);
  EXPECT_TRUE(channels.empty());
}

TEST_F(TcpListenerTest, MayBeDestroyedInItsCallback) {
  std::unique_ptr<TcpListener> listener;
  int calls = 0;
  listener = std::make_unique<TcpListener>(context, "127.0.0.1", 0,
                                           [&, marker = std::string(100, 'm')](auto channel) {
                                             listener.reset();
                                             channels.push_back(std::move(channel));
                                             calls += marker.size() == 100;
                                           });
  const tcp::socket first = connectTo(*listener);
  const tcp::socket second = connectTo(*listener);
  EXPECT_TRUE(runUntil(context, [&] { return calls > 0; }));
  runReady(context);
  EXPECT_EQ(calls, 1);
}

TEST_F(TcpListenerTest, SurvivesRunningOutOfDescriptors) {
  TcpListener listener(context, "127.0.0.1", 0, keep());
  runReady(context);
  const tcp::socket client = connectTo(listener);
  {
    const NoDescriptorsLeft shortage;
    EXPECT_TRUE(runUntil(context, [&] { return listener.failedAccepts() >= 2; }));
    EXPECT_TRUE(channels.empty());
  }
  EXPECT_TRUE(runUntil(context, [&] { return channels.size() == 1; }));
}

}  // namespace
}  // namespace naiad::test
