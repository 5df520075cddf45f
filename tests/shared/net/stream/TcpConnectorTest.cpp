#include <gtest/gtest.h>

#include <vector>

#include "shared/net/stream/TcpConnector.h"
#include "shared/net/stream/TcpListener.h"
#include "tests/shared/net/Loopback.h"
#include "tests/shared/net/Recorder.h"

namespace naiad::test {
namespace {

using namespace std::chrono_literals;

struct TcpConnectorTest : testing::Test {
  TcpConnector::Done done() {
    return [this](std::unique_ptr<ReliableChannel> made, const std::string& sentence) {
      channel = std::move(made);
      error = sentence;
      ++calls;
    };
  }
  bool runUntilDone() {
    return runUntil(context, [&] { return calls > 0; });
  }
  /// A port of 127.0.0.1 without a listener.
  std::uint16_t closedPort() {
    return TcpListener(context, "127.0.0.1", 0, [](auto) {}).port();
  }

  asio::io_context context;
  TcpConnector connector{context};
  std::unique_ptr<ReliableChannel> channel;
  std::string error;
  int calls = 0;
};

TEST_F(TcpConnectorTest, DeliversAChannelThatWorks) {
  for (const std::string host : {"127.0.0.1", "localhost"}) {
    std::unique_ptr<ReliableChannel> accepted;
    TcpListener listener(context, "127.0.0.1", 0, [&](auto made) { accepted = std::move(made); });
    calls = 0;
    connector.connect(host, listener.port(), 10s, done());
    EXPECT_EQ(calls, 0);
    ASSERT_TRUE(runUntil(context, [&] { return calls > 0 && accepted; })) << host;
    ASSERT_TRUE(channel) << error;
    EXPECT_EQ(error, "");
    EXPECT_EQ(channel->peerAddress(), listener.address());
    Recorder recorder;
    accepted->start(recorder.callbacks());
    channel->send("hello");
    EXPECT_TRUE(runUntil(context, [&] { return !recorder.frames.empty(); }));
  }
}

TEST_F(TcpConnectorTest, ConnectsOverIPv6) {
  if (!haveIPv6Loopback()) GTEST_SKIP() << "no IPv6 loopback on this machine";
  TcpListener listener(context, "::1", 0, [](auto) {});
  connector.connect("::1", listener.port(), 10s, done());
  ASSERT_TRUE(runUntilDone());
  ASSERT_TRUE(channel) << error;
  EXPECT_EQ(channel->peerAddress(), listener.address());
}

TEST_F(TcpConnectorTest, PortWithoutListenerGivesASentence) {
  const std::uint16_t port = closedPort();
  connector.connect("127.0.0.1", port, 10s, done());
  ASSERT_TRUE(runUntilDone());
  EXPECT_FALSE(channel);
  EXPECT_EQ(error, "Nothing listens on 127.0.0.1:" + std::to_string(port) + " (connection refused).");
}

TEST_F(TcpConnectorTest, OtherMachinesAreRefused) {
  for (const std::string host : {"192.0.2.1", "2001:db8::1"}) {
    calls = 0;
    connector.connect(host, 9876, 10s, done());
    ASSERT_TRUE(runUntilDone());
    EXPECT_FALSE(channel);
    EXPECT_EQ(error, host + " is another machine: without encryption only loopback addresses are allowed.");
  }
}

TEST_F(TcpConnectorTest, UnknownNameGivesASentence) {
  const std::string host = std::string(70, 'x') + ".invalid";  // too long for a look-up to leave the machine
  connector.connect(host, 9876, 20s, done());
  ASSERT_TRUE(runUntilDone());
  EXPECT_FALSE(channel);
  EXPECT_EQ(error.find("The host name \"" + host + "\" could not be found ("), 0u) << error;
}

TEST_F(TcpConnectorTest, SilenceEndsInATimeout) {
  // A full backlog: the kernel leaves further connections unanswered.
  tcp::acceptor acceptor(context, tcp::v4());
  acceptor.bind({asio::ip::address_v4::loopback(), 0});
  acceptor.listen(1);
  std::vector<tcp::socket> fill;
  for (int i = 0; i < 16; ++i) {
    fill.emplace_back(context).async_connect(acceptor.local_endpoint(), [](const std::error_code&) {});
  }
  const std::uint16_t port = acceptor.local_endpoint().port();
  connector.connect("127.0.0.1", port, 250ms, done());
  ASSERT_TRUE(runUntilDone());
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

TEST_F(TcpConnectorTest, TriesAgainFromItsOwnCallbackUntilTheServerIsBack) {
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
