// A busy server. Its clients' streams pass through a proxy; their datagrams do not.
#pragma once

#include <memory>
#include <string>
#include <utility>

#include "Compare.h"
#include "LoopbackFixture.h"
#include "StreamProxy.h"
#include "Valve.h"

namespace naiad::test {

class ProxiedServer : public LoopbackFixture {
 protected:
  void start(HostOptions options) {
    server = std::make_unique<TestServer>(busyWorld(50, &census), std::move(options));
    proxy = std::make_unique<StreamProxy>(context, server->port());
    valve->server_port = server->port();
  }
  void start() { start(home.server()); }
  virtual ClientSetup player(const std::string& name) {
    ClientSetup setup = home.player(name);
    setup.options.open_socket = through(context, valve);
    return setup;
  }
  /// Waits until a picture after this call equals the server's.
  bool seesTheTruth(TestClient& client) {
    client.forgetPictures();
    return serveUntil(context, {&client}, [&] { return showsTheTruth(client, *server); });
  }
  void expectNoJoinOrLeave(int players = 1) {
    EXPECT_EQ(census.joins, players);
    EXPECT_EQ(census.leaves, 0);
    EXPECT_EQ(server->counters().joined, static_cast<std::uint64_t>(players));
  }

  Census census;
  std::shared_ptr<Valve> valve = std::make_shared<Valve>();
  std::unique_ptr<TestServer> server;
  std::unique_ptr<StreamProxy> proxy;
};

}  // namespace naiad::test
