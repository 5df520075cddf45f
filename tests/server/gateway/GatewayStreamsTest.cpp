// The other end of a gateway's WebSockets where no browser is: dfclient's and dfbot's.
#include <gtest/gtest.h>

#include <atomic>
#include <future>
#include <memory>

#include "client/session/WebSocket.h"
#include "tests/server/gateway/FakeGame.h"
#include "tests/server/gateway/GatewayRun.h"

namespace naiad::test {
namespace {

/// What a WebSocket reported. Outlives the sockets' thread.
struct Reports {
  std::atomic<int> opened{0};
  std::atomic<int> refused{0};
  std::atomic<int> closed{0};
  std::atomic<int> frames{0};

  WebSocket::Events events() {
    return {[this](const std::string& error) { ++(error.empty() ? opened : refused); },
            [this](const std::string&) { ++frames; }, [this](bool) { ++closed; }};
  }
};

class GatewayStreams : public testing::Test {
 protected:
  void start(FakeGame::OnFrame on_frame = {}) {
    game = std::make_unique<FakeGame>(home.path("identity"), home.path("visitors"), std::move(on_frame));
    gateway = std::make_unique<GatewayRun>(home.settings(game->key()));
    address = *GatewayAddress::parse("http://127.0.0.1:" + std::to_string(gateway->port()));
  }

  GatewayHome home;
  std::unique_ptr<FakeGame> game;
  std::unique_ptr<GatewayRun> gateway;
  GatewayAddress address;
  Reports reports;
  WebSocketThread thread;
};

TEST_F(GatewayStreams, FramesGoBothWays) {
  start();
  const auto socket = WebSocket::open(thread, address, reports.events());
  ASSERT_TRUE(comesTrue([&] { return reports.opened == 1; }));
  for (int i = 0; i < 100; ++i) socket->send("frame " + std::to_string(i));
  EXPECT_TRUE(comesTrue([&] { return reports.frames == 100; }));
  EXPECT_EQ(socket->unsentBytes(), 0U);
}

TEST_F(GatewayStreams, AGatewayThatIsKilledWhileMuchIsUnsentIsReportedOnce) {
  std::promise<void> end;
  start([wait = end.get_future().share()](ReliableChannel&, const std::string&) { wait.wait(); });
  const auto socket = WebSocket::open(thread, address, reports.events());
  ASSERT_TRUE(comesTrue([&] { return reports.opened == 1; }));
  for (int i = 0; i < 5000; ++i) socket->send(std::string(i == 0 ? 100 : 4000, 'x'));
  // The game reads nothing, so in the end neither does the gateway, and a write stays under way.
  ASSERT_TRUE(comesTrue([&] { return game->frameCount() > 0; }));
  std::size_t before = 0;
  ASSERT_TRUE(comesTrue([&] {
    const std::size_t now = socket->unsentBytes();
    const bool stands = now == before;
    before = now;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));  // to see that it does not change
    return stands;
  }));
  ASSERT_GT(socket->unsentBytes(), 0U);
  gateway.reset();
  EXPECT_TRUE(comesTrue([&] { return reports.closed > 0; }));
  end.set_value();
  // What is written next to a socket that has ended comes back on the sockets' thread before this one opens.
  Reports later;
  const auto next = WebSocket::open(thread, address, later.events());
  EXPECT_TRUE(comesTrue([&] { return later.refused == 1; }));
  EXPECT_EQ(reports.closed, 1);
}

TEST_F(GatewayStreams, WithoutEncryptionNoOtherMachineIsConnectedTo) {
  const auto socket = WebSocket::open(thread, *GatewayAddress::parse("http://192.0.2.1"), reports.events());
  EXPECT_TRUE(comesTrue([&] { return reports.refused == 1; }));
}

}  // namespace
}  // namespace naiad::test
