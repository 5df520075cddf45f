// Clients served by the test's own thread, and a home for their files.
#pragma once

#include <gtest/gtest.h>

#include <asio/io_context.hpp>
#include <chrono>
#include <string>

#include "BusyWorld.h"
#include "Home.h"
#include "TestClient.h"
#include "TestServer.h"

namespace naiad::test {

class LoopbackFixture : public testing::Test {
 protected:
  bool isJudged(TestClient& client) {
    return serveUntil(context, {&client}, [&] { return client.joined() || client.connection().isOver(); });
  }
  testing::AssertionResult joins(TestClient& client) {
    if (isJudged(client) && client.joined()) return testing::AssertionSuccess();
    return testing::AssertionFailure() << "state " << static_cast<int>(client.connection().state()) << ": "
                                       << client.connection().message();
  }
  /// Returns the message with which a client is refused; empty if it joins.
  std::string refusal(TestClient& client) {
    EXPECT_TRUE(isJudged(client));
    return client.joined() ? "" : client.connection().message();
  }
  bool ends(TestClient& client) {
    return serveUntil(context, {&client}, [&] { return client.connection().isOver(); });
  }
  /// Waits until the client receives its pictures as datagrams.
  bool settles(TestClient& client) {
    return serveUntil(context, {&client}, [&] { return isOnDatagrams(client); });
  }
  /// Waits until the client has received this many more ticks.
  bool hears(TestClient& client, std::uint32_t ticks) {
    const std::uint32_t until = client.newestTick() + ticks;
    return serveUntil(context, {&client}, [&] { return client.newestTick() >= until; });
  }
  /// Presses a key. True if the score rises, which in a busy world is the number of keys that reached it.
  bool keyWorks(TestClient& client) {
    const std::int32_t before = client.session().score();
    press(client, df::Keyboard::RIGHTARROW);
    return serveUntil(context, {&client}, [&] { return client.session().score() > before; });
  }

  Home home;
  asio::io_context context;
};

}  // namespace naiad::test
