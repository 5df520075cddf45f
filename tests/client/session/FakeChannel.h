// A ReliableChannel that sends nowhere and remembers.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "naiad.pb.h"
#include "shared/net/base/Channel.h"

namespace naiad::test {

class FakeChannel : public ReliableChannel {
 public:
  /// Outlives the channel: what the client did.
  struct Log {
    std::vector<wire::ClientMessage> sent;
    bool closed = false;
    std::size_t receive_limit = 0;
    std::size_t unsent = 0;  ///< what unsentBytes() shall say
  };

  explicit FakeChannel(std::shared_ptr<Log> log) : m_log(std::move(log)) {}
  void start(Callbacks) override {}
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
