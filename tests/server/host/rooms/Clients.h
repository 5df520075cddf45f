// Clients on fake channels, for tests of how a host handles hellos.
#pragma once

#include <string>

#include "host/rooms/SessionTable.h"
#include "naiad.pb.h"
#include "shared/net/base/Limits.h"
#include "tests/support/MessageLine.h"

namespace naiad::test {

/// The client's end of a stream. Must outlive the session.
struct Client : MessageLine<wire::ServerMessage> {
  Client() { address = "192.0.2.1:1"; }

  void greet(const wire::Hello& hello) const {
    wire::ClientMessage message;
    *message.mutable_hello() = hello;
    receive(message);
  }
  void drop() const { callbacks.on_closed(CloseReason::kPeer); }
  bool isWelcome() const { return !sent.empty() && sent.front().has_welcome(); }
  const wire::Welcome& welcome() const { return sent.front().welcome(); }
  bool isRefused() const { return !sent.empty() && sent.front().has_refused(); }
  wire::Refused::Reason refusal() const { return sent.front().refused().reason(); }
};

inline wire::Hello helloOf(const std::string& name) {
  wire::Hello hello;
  hello.set_magic(kHelloMagic);
  hello.set_protocol(kProtocolVersion);
  hello.set_player_name(name);
  return hello;
}

}  // namespace naiad::test
