// A ReliableChannel that leads nowhere: the test plays the server.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "naiad.pb.h"
#include "shared/net/base/Channel.h"

namespace naiad::test {

class FakeChannel : public ReliableChannel {
 public:
  /// What the client did; outlives the channel.
  struct Log {
    std::vector<wire::ClientMessage> sent;
    bool closed = false;
    std::size_t receive_limit = 0;
    std::size_t unsent = 0;  ///< what unsentBytes() returns
    bool destroyed = false;
    Callbacks callbacks;

    void receive(const wire::ServerMessage& message) const {
      const auto on_frame = callbacks.on_frame;  // the callee may destroy the channel
      on_frame(message.SerializeAsString());
    }
  };

  explicit FakeChannel(std::shared_ptr<Log> log) : m_log(std::move(log)) {}
  ~FakeChannel() override { m_log->destroyed = true; }
  void start(Callbacks callbacks) override { m_log->callbacks = std::move(callbacks); }
  void send(std::string_view frame) override {
    wire::ClientMessage message;
    if (message.ParseFromArray(frame.data(), static_cast<int>(frame.size()))) m_log->sent.push_back(message);
  }
  std::size_t unsentBytes() const override { return m_log->unsent; }
  void close() override { m_log->closed = true; }
  std::string peerAddress() const override { return "fake"; }
  void setReceiveLimit(std::size_t bytes) override { m_log->receive_limit = bytes; }

 private:
  std::shared_ptr<Log> m_log;
};

}  // namespace naiad::test
