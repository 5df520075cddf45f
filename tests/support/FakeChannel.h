// A ReliableChannel without a network: the test plays the other end.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <utility>

#include "shared/net/base/Channel.h"

namespace naiad::test {

/// Shows what the code under test did with its FakeChannel. Must outlive the channel.
struct FakeLine {
  ReliableChannel::Callbacks callbacks;
  std::string address = "fake:1";
  std::size_t receive_limit = 0;
  std::size_t unsent = 0;  ///< result of unsentBytes()
  bool closed = false;
  bool destroyed = false;
  std::function<void(std::string_view frame)> on_send;  ///< empty: frames are dropped

  /// Delivers this message as if the other end had sent it.
  template <class Message>
  void receive(const Message& message) const {
    const auto on_frame = callbacks.on_frame;  // the callee may destroy the channel
    on_frame(message.SerializeAsString());
  }
};

class FakeChannel : public ReliableChannel {
 public:
  /// Several channels may use one line, one after another.
  explicit FakeChannel(FakeLine& line) : m_line(line) { m_line.closed = false; }
  ~FakeChannel() override { m_line.destroyed = true; }
  void start(Callbacks callbacks) override { m_line.callbacks = std::move(callbacks); }
  void send(std::string_view frame) override {
    if (m_line.on_send) m_line.on_send(frame);
  }
  std::size_t unsentBytes() const override { return m_line.unsent; }
  void close() override { m_line.closed = true; }
  std::string peerAddress() const override { return m_line.address; }
  void setReceiveLimit(std::size_t bytes) override { m_line.receive_limit = bytes; }

 private:
  FakeLine& m_line;
};

}  // namespace naiad::test
