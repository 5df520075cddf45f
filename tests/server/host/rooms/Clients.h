// Clients on fake channels, and their messages to a host or a session.
#pragma once

#include <cstdint>
#include <string>

#include "naiad.pb.h"
#include "shared/net/base/Limits.h"
#include "shared/replica/UpdateCodec.h"
#include "tests/support/MessageLine.h"

namespace naiad::test {

inline wire::Hello helloOf(const std::string& name) {
  wire::Hello hello;
  hello.set_magic(kHelloMagic);
  hello.set_protocol(kProtocolVersion);
  hello.set_player_name(name);
  return hello;
}

/// The client's end of a stream. Must outlive the session.
struct Client : MessageLine<wire::ServerMessage> {
  Client() { address = "192.0.2.1:1"; }

  void greet(const wire::Hello& hello) const {
    wire::ClientMessage message;
    *message.mutable_hello() = hello;
    receive(message);
  }
  void say(const std::string& text, std::uint32_t number = 0) const {
    wire::ClientMessage message;
    message.mutable_chat()->set_text(text);
    message.set_number(number);
    receive(message);
  }
  /// `received`: number of the newest reliable frame that the client has.
  void ping(std::uint32_t received = 0) const {
    wire::ClientMessage message;
    message.mutable_ping()->set_token(1);
    message.mutable_ping()->set_last_frame(received);
    receive(message);
  }
  void update(const ClientUpdate& changes) const {
    wire::ClientMessage message;
    message.set_update(writeUpdate(changes));
    receive(message);
  }
  void key(std::uint32_t id, int which = 0, int action = 0) const {
    ClientUpdate changes;
    changes.inputs = {
        {.id = id, .action = static_cast<std::uint8_t>(action), .key = static_cast<std::uint8_t>(which)}};
    update(changes);
  }
  void enter(const std::string& room) const {
    wire::ClientMessage message;
    message.mutable_enter_room()->set_room(room);
    receive(message);
  }
  void leave() const {
    wire::ClientMessage message;
    message.mutable_leave();
    receive(message);
  }
  void drop() const { callbacks.on_closed(CloseReason::kPeer); }

  bool isWelcome() const { return !sent.empty() && sent.front().has_welcome(); }
  const wire::Welcome& welcome() const { return sent.front().welcome(); }
  bool isRefused() const { return !sent.empty() && sent.front().has_refused(); }
  wire::Refused::Reason refusal() const { return sent.front().refused().reason(); }
};

}  // namespace naiad::test
