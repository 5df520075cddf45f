// Clients served by the test's own thread, and a home for their files.
#pragma once

#include <gtest/gtest.h>

#include <asio/io_context.hpp>
#include <functional>
#include <memory>
#include <string>

#include "BusyWorld.h"
#include "Home.h"
#include "TestClient.h"
#include "TestServer.h"
#include "Valve.h"

namespace naiad::test {

class LoopbackFixture : public testing::Test {
 protected:
  /// Returns a player's setup whose datagrams pass the valve.
  ClientSetup playerWithValve(const std::string& name) {
    ClientSetup setup = home.player(name);
    setup.options.open_socket = through(context, valve);
    return setup;
  }
  /// Serves the client until `done` returns true; false after kPatience.
  bool serve(TestClient& client, const std::function<bool()>& done) {
    return serveUntil(context, {&client}, done);
  }
  bool isJudged(TestClient& client) {
    return serve(client, [&] { return client.joined() || client.connection().isOver(); });
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
    return serve(client, [&] { return client.connection().isOver(); });
  }
  /// Waits until the client receives its pictures as datagrams.
  bool settles(TestClient& client) {
    return serve(client, [&] { return isOnDatagrams(client); });
  }
  /// Waits until the client has received this many more ticks.
  bool hears(TestClient& client, std::uint32_t ticks) {
    const std::uint32_t until = client.newestTick() + ticks;
    return serve(client, [&] { return client.newestTick() >= until; });
  }
  /// Presses a key. True if the score rises, which in a busy world is the number of keys that reached it.
  bool keyWorks(TestClient& client) {
    const std::int32_t before = client.session().score();
    press(client, df::Keyboard::RIGHTARROW);
    return serve(client, [&] { return client.session().score() > before; });
  }

  Home home;
  asio::io_context context;
  std::shared_ptr<Valve> valve = std::make_shared<Valve>();
};

}  // namespace naiad::test
