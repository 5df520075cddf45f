#pragma once

// A server at 30 Hz that is 50 ms away in each direction.
#include <functional>
#include <memory>
#include <utility>

#include "LoopbackFixture.h"
#include "StreamProxy.h"
#include "Valve.h"

namespace naiad::test {

class FarServer : public LoopbackFixture {
 protected:
  void start(std::function<void(df::World&)> populate) {
    HostOptions options = home.server();
    options.frame_micros = 0;  // 30 Hz, the default
    server = std::make_unique<TestServer>(std::move(populate), options);
    proxy = std::make_unique<StreamProxy>(context, server->port());
    proxy->setDelay(std::chrono::milliseconds(50));
    valve->delay = std::chrono::milliseconds(50);
    valve->server_port = server->port();
  }
  ClientSetup player(const std::string& name) {
    ClientSetup setup = home.player(name);
    setup.options.open_socket = through(context, valve);
    return setup;
  }

  std::shared_ptr<Valve> valve = std::make_shared<Valve>();
  std::unique_ptr<TestServer> server;
  std::unique_ptr<StreamProxy> proxy;
};

}  // namespace naiad::test
