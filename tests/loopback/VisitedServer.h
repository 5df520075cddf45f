// A server with a visitors' socket, and clients that connect through it with any visitor address.
#pragma once

#include <string>

#include "LoopbackFixture.h"
#include "shared/net/stream/ProxyHeader.h"

namespace naiad::test {

class VisitedServer : public LoopbackFixture {
 protected:
  VisitedServer() {
    options = home.server();
    options.visitors = home.identity("visitors");
  }
  /// Returns the setup of a client that uses the visitors' socket, for example from "192.0.2.7:50312".
  ClientSetup from(const std::string& address, const std::string& name) const {
    ClientSetup setup = home.player(name);
    setup.options.proxy = ProxyOptions{options.visitors, *proxiedPeerFromText(address)};
    return setup;
  }

  HostOptions options;
};

}  // namespace naiad::test
