// A server with a visitors' socket, and clients who come through it from wherever the test says.
#pragma once

#include <string>

#include "LoopbackFixture.h"
#include "shared/net/stream/VisitorHeader.h"

namespace naiad::test {

class VisitedServer : public LoopbackFixture {
 protected:
  VisitedServer() {
    options = home.server();
    options.visitors = home.identity("visitors");
  }
  /// A client who comes through the visitors' socket, from "192.0.2.7:50312".
  ClientSetup from(const std::string& address, const std::string& name) const {
    ClientSetup setup = home.player(name);
    setup.options.visit = Visit{options.visitors, *visitorFromText(address)};
    return setup;
  }

  HostOptions options;
};

}  // namespace naiad::test
