// A server with a visitors' socket, and clients who come through it from wherever the test says.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "BusyWorld.h"
#include "Home.h"
#include "TestServer.h"
#include "shared/net/stream/VisitorHeader.h"

namespace naiad::test {

class VisitedServer : public testing::Test {
 protected:
  VisitedServer() {
    options = home.server();
    options.visitors = home.identity("visitors");
  }
  static std::function<void(df::World&)> world() {
    return [](df::World& world) { populateBusyWorld(world, 5); };
  }
  /// A client who comes through the visitors' socket, from "192.0.2.7:50312".
  ClientSetup from(const std::string& address, const std::string& name) const {
    ClientSetup setup = home.player(name);
    setup.options.visit = Visit{options.visitors, *visitorFromText(address)};
    return setup;
  }
  bool joins(TestClient& client) {
    return serveUntil(context, {&client}, [&] { return client.joined() || client.connection().isOver(); }) &&
           client.joined();
  }
  bool ends(TestClient& client) {
    return serveUntil(context, {&client}, [&] { return client.connection().isOver(); });
  }
  /// The sentence with which a client is not let in; empty: it is.
  std::string refusal(TestClient& client) { return joins(client) ? "" : client.connection().sentence(); }

  Home home;
  asio::io_context context;
  HostOptions options;
};

}  // namespace naiad::test
