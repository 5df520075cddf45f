// Clients on channels that lead nowhere, for tests of what a host does with hellos.
#pragma once

#include <deque>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "host/program/SessionTable.h"
#include "naiad.pb.h"
#include "shared/net/base/Limits.h"

namespace naiad::test {

/// A client's end of its stream. Outlives the session.
struct Client {
  std::string address = "192.0.2.1:1";
  ReliableChannel::Callbacks callbacks;
  std::vector<wire::ServerMessage> received;
  bool closed = false;
  bool destroyed = false;

  void say(const wire::ClientMessage& message) const { callbacks.on_frame(message.SerializeAsString()); }
  void greet(const wire::Hello& hello) const {
    wire::ClientMessage message;
    *message.mutable_hello() = hello;
    say(message);
  }
  /// The stream breaks.
  void drop() const { callbacks.on_closed(CloseReason::kPeer); }
  bool isWelcome() const { return !received.empty() && received.front().has_welcome(); }
  const wire::Welcome& welcome() const { return received.front().welcome(); }
  bool isRefused() const { return !received.empty() && received.front().has_refused(); }
  wire::Refused::Reason refusal() const { return received.front().refused().reason(); }
};

class ClientChannel : public ReliableChannel {
 public:
  explicit ClientChannel(Client& client) : m_client(client) {}
  ~ClientChannel() override { m_client.destroyed = true; }
  void start(Callbacks callbacks) override { m_client.callbacks = std::move(callbacks); }
  void send(std::string_view frame) override {
    m_client.received.emplace_back().ParseFromArray(frame.data(), static_cast<int>(frame.size()));
  }
  std::size_t unsentBytes() const override { return 0; }
  void close() override { m_client.closed = true; }
  std::string peerAddress() const override { return m_client.address; }
  void setReceiveLimit(std::size_t) override {}

 private:
  Client& m_client;
};

inline wire::Hello helloOf(const std::string& name) {
  wire::Hello hello;
  hello.set_magic(kHelloMagic);
  hello.set_protocol(kProtocolVersion);
  hello.set_player_name(name);
  return hello;
}

}  // namespace naiad::test
