// GatewayStreamOpener: WebSockets to a gateway that dfclient and dfbot open, without a browser.
#include <gtest/gtest.h>

#include <asio/io_context.hpp>
#include <asio/write.hpp>
#include <future>
#include <memory>
#include <optional>

#include "client/session/GatewayStreamOpener.h"
#include "shared/net/base/Limits.h"
#include "tests/server/gateway/FakeGame.h"
#include "tests/shared/net/Loopback.h"
#include "tests/shared/net/Recorder.h"

namespace naiad::test {
namespace {

class GatewayStreamOpenerTest : public GatewayFixture {
 protected:
  GatewayAddress address() const {
    return *GatewayAddress::parse("http://127.0.0.1:" + std::to_string(gateway->port()));
  }
  /// Opens a stream. Waits until there is a channel or an error message.
  void open(StreamOpener& opened) {
    error.reset();
    opened.open([this](std::unique_ptr<ReliableChannel> made, const std::string& sentence) {
      channel = std::move(made);
      error = sentence;
    });
    ASSERT_TRUE(runUntil(context, [&] { return error.has_value(); }));
    if (channel) channel->start(recorder.callbacks());
  }
  void connect(FakeGame::OnFrame on_frame = {}) {
    start(std::move(on_frame));
    streams.emplace(context, address());
    open(*streams);
    ASSERT_TRUE(channel) << *error;
  }
  bool runUntilClosed() {
    return runUntil(context, [&] { return recorder.closed.has_value(); });
  }

  asio::io_context context;
  Recorder recorder;
  std::optional<std::string> error;
  std::optional<GatewayStreamOpener> streams;
  std::unique_ptr<ReliableChannel> channel;
};

TEST_F(GatewayStreamOpenerTest, FramesGoBothWays) {
  ASSERT_NO_FATAL_FAILURE(connect());
  std::vector<std::string> frames;
  for (int i = 0; i < 100; ++i) frames.push_back("frame " + std::to_string(i));
  for (const std::string& frame : frames) channel->send(frame);
  EXPECT_TRUE(runUntil(context, [&] { return recorder.frames.size() == frames.size(); }));
  EXPECT_EQ(recorder.frames, frames);
  EXPECT_EQ(channel->unsentBytes(), 0U);
  channel->close();
  EXPECT_TRUE(runUntilClosed());
  EXPECT_EQ(recorder.closed, CloseReason::kLocal);
}

TEST_F(GatewayStreamOpenerTest, FramesOfTheLargestSizeArrive) {
  const std::string largest(kMaxServerFrame, 'x');
  ASSERT_NO_FATAL_FAILURE(connect([&](ReliableChannel& to, const std::string&) { to.send(largest); }));
  channel->send("hello");
  EXPECT_TRUE(runUntil(context, [&] { return !recorder.frames.empty(); }));
  EXPECT_EQ(recorder.frames, std::vector<std::string>{largest});
}

TEST_F(GatewayStreamOpenerTest, GameClosingItsStreamIsReportedAsPeerClose) {
  ASSERT_NO_FATAL_FAILURE(connect([](ReliableChannel& to, const std::string&) { to.close(); }));
  channel->send("hello");
  EXPECT_TRUE(runUntilClosed());
  EXPECT_EQ(recorder.closed, CloseReason::kPeer);
}

TEST_F(GatewayStreamOpenerTest, GatewayWithoutAServerIsAnError) {
  start();
  game.reset();
  streams.emplace(context, address());
  open(*streams);
  ASSERT_TRUE(channel) << *error;
  channel->send("hello");
  EXPECT_TRUE(runUntilClosed());
  EXPECT_EQ(recorder.closed, CloseReason::kError);
}

TEST_F(GatewayStreamOpenerTest, GatewayLossWithPendingWritesIsReportedOnce) {
  std::promise<void> end;
  ASSERT_NO_FATAL_FAILURE(
      connect([wait = end.get_future().share()](ReliableChannel&, const std::string&) { wait.wait(); }));
  channel->send(std::string(100, 'x'));
  // The game reads nothing, so at last the gateway stops reading, too, and a write of the client stays
  // pending.
  ASSERT_TRUE(runUntil(context, [&] { return game->frameCount() > 0; }));
  ASSERT_TRUE(runUntil(context, [&] {
    channel->send(std::string(4000, 'x'));
    return channel->unsentBytes() > 400'000;
  }));
  gateway.reset();
  EXPECT_TRUE(runUntilClosed());
  end.set_value();
  runReady(context);
  EXPECT_EQ(recorder.closings, 1);
  EXPECT_EQ(recorder.closed, CloseReason::kError);
}

TEST_F(GatewayStreamOpenerTest, UnreachableOrRefusingGatewayIsReported) {
  start();
  const GatewayAddress here = address();
  gateway.reset();
  GatewayStreamOpener gone(context, here);
  open(gone);
  EXPECT_EQ(error, "The gateway cannot be reached (connection refused).");

  tcp::acceptor acceptor(context, {asio::ip::address_v4::loopback(), 0});
  GatewayStreamOpener other(
      context,
      *GatewayAddress::parse("http://127.0.0.1:" + std::to_string(acceptor.local_endpoint().port())));
  std::optional<tcp::socket> peer;
  acceptor.async_accept([&](const std::error_code&, tcp::socket socket) {
    asio::write(socket, asio::buffer(std::string("HTTP/1.1 403 No\r\nContent-Length: 0\r\n\r\n")));
    peer.emplace(std::move(socket));
  });
  open(other);
  EXPECT_EQ(error, "Cannot join through the gateway (status 403).");
}

TEST_F(GatewayStreamOpenerTest, WithoutEncryptionNoOtherMachineIsConnectedTo) {
  GatewayStreamOpener other(context, *GatewayAddress::parse("http://192.0.2.1"));
  open(other);
  EXPECT_EQ(error, "Without encryption (https) only gateways on this machine are allowed.");
}

TEST_F(GatewayStreamOpenerTest, NothingIsCalledAfterCancel) {
  start();
  GatewayStreamOpener other(context, address());
  other.open([this](std::unique_ptr<ReliableChannel>, const std::string& sentence) { error = sentence; });
  other.cancel();
  context.run();
  EXPECT_FALSE(error);
}

}  // namespace
}  // namespace naiad::test
