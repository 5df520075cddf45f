#include <gtest/gtest.h>

#include <vector>

#include "TlsFixture.h"

namespace naiad::test {
namespace {

using namespace std::chrono_literals;
using namespace std::string_literals;

struct TcpConnectorTest : ConnectFixture {
  /// Returns a port of 127.0.0.1 without a listener.
  std::uint16_t closedPort() {
    return TcpListener(context, "127.0.0.1", 0, [](auto) {}).port();
  }
  /// Connects and waits for the result.
  void connect(const std::string& host, std::uint16_t port, std::chrono::milliseconds timeout = 20s) {
    calls = 0;
    connector.connect(host, port, timeout, done());
    EXPECT_EQ(calls, 0);
    ASSERT_TRUE(runUntilDone()) << host;
  }
  TcpConnector connector{context};
};

TEST_F(TcpConnectorTest, DeliversAWorkingChannel) {
  for (const std::string host : {"127.0.0.1", "localhost", "::1"}) {
    const bool is_ipv6 = host == "::1";
    if (is_ipv6 && !haveIPv6Loopback()) GTEST_SKIP() << "no IPv6 loopback on this machine";
    std::unique_ptr<ReliableChannel> accepted;
    TcpListener listener(context, is_ipv6 ? host : "127.0.0.1", 0,
                         [&](auto made) { accepted = std::move(made); });
    connect(host, listener.port());
    ASSERT_TRUE(runUntil(context, [&] { return accepted != nullptr; })) << host;
    ASSERT_TRUE(channel) << error;
    EXPECT_EQ(error, "");
    EXPECT_EQ(channel->peerAddress(), listener.address());
    Recorder recorder;
    accepted->start(recorder.callbacks());
    channel->send("hello");
    EXPECT_TRUE(runUntil(context, [&] { return !recorder.frames.empty(); }));
  }
}

TEST_F(TcpConnectorTest, UnreachableHostsGiveAClearError) {
  const std::uint16_t port = closedPort();
  const std::string unknown = std::string(70, 'x') + ".invalid";  // too long for a DNS query
  const std::string far = " is another machine: without encryption only loopback addresses are allowed.";
  for (const auto& [host, sentence] :
       {std::pair{"127.0.0.1"s,
                  "Nothing listens on 127.0.0.1:" + std::to_string(port) + " (connection refused)."},
        {"192.0.2.1", "192.0.2.1" + far},
        {"2001:db8::1", "2001:db8::1" + far},
        {unknown, "The host name \"" + unknown + "\" could not be found ("}}) {
    connect(host, port);
    EXPECT_FALSE(channel) << host;
    EXPECT_EQ(host == unknown ? error.substr(0, sentence.size()) : error, sentence);
  }
}

TEST_F(TcpConnectorTest, SilenceEndsInATimeout) {
  // With a full backlog, the kernel leaves further connections unanswered.
  tcp::acceptor acceptor(context, tcp::v4());
  acceptor.bind({asio::ip::address_v4::loopback(), 0});
  acceptor.listen(1);
  std::vector<tcp::socket> fill;
  for (int i = 0; i < 16; ++i)
    fill.emplace_back(context).async_connect(acceptor.local_endpoint(), [](const std::error_code&) {});
  const std::uint16_t port = acceptor.local_endpoint().port();
  connect("127.0.0.1", port, 250ms);
  if (channel) GTEST_SKIP() << "this kernel accepts connections beyond a full backlog";
  EXPECT_EQ(error, "No answer from 127.0.0.1:" + std::to_string(port) + " within 250 ms.");
}

TEST_F(TcpConnectorTest, CancelledAttemptStaysSilent) {
  TcpListener listener(context, "127.0.0.1", 0, [](auto) {});
  connector.connect("127.0.0.1", listener.port(), 10s, [](auto, const auto&) { FAIL() << "cancelled"; });
  connector.cancel();
  connector.connect("127.0.0.1", listener.port(), 10s, [](auto, const auto&) { FAIL() << "replaced"; });
  connector.connect("127.0.0.1", listener.port(), 10s, done());
  EXPECT_TRUE(runUntilDone());
  EXPECT_TRUE(channel) << error;
}

TEST_F(TcpConnectorTest, MayBeDestroyedInItsCallback) {
  TcpListener listener(context, "127.0.0.1", 0, [](auto) {});
  auto mortal = std::make_unique<TcpConnector>(context);
  mortal->connect("127.0.0.1", listener.port(), 10s, [&](auto made, const std::string&) {
    mortal.reset();
    channel = std::move(made);
    ++calls;
  });
  EXPECT_TRUE(runUntilDone());
  EXPECT_TRUE(channel);
}

TEST_F(TcpConnectorTest, RetriesFromItsCallbackUntilTheServerReturns) {
  const std::uint16_t port = closedPort();
  std::unique_ptr<TcpListener> listener;
  TcpConnector::Done again = [&](std::unique_ptr<ReliableChannel> made, const std::string&) {
    channel = std::move(made);
    if (channel) return;
    if (++calls == 3) listener = std::make_unique<TcpListener>(context, "127.0.0.1", port, [](auto) {});
    connector.connect("127.0.0.1", port, 10s, again);
  };
  connector.connect("127.0.0.1", port, 10s, again);
  EXPECT_TRUE(runUntil(context, [&] { return channel != nullptr; }));
  EXPECT_EQ(calls, 3);
}

}  // namespace
}  // namespace naiad::test
