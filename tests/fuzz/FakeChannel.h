// A ReliableChannel that leads nowhere: the target plays the other end.
#pragma once

#include "Channel.h"

namespace naiad::fuzz {

/// What the channel was told; outlives the channel.
struct FakeLine {
  ReliableChannel::Callbacks callbacks;
  std::size_t receive_limit = 0;
  std::size_t unsent = 0;  ///< what unsentBytes() shall say
  bool closed = false;
};

class FakeChannel : public ReliableChannel {
 public:
  explicit FakeChannel(FakeLine& line) : m_line(line) {}
  void start(Callbacks callbacks) override { m_line.callbacks = std::move(callbacks); }
  void send(std::string_view) override {}
  std::size_t unsentBytes() const override { return m_line.unsent; }
  void close() override { m_line.closed = true; }
  std::string peerAddress() const override { return "fake:1"; }
  void setReceiveLimit(std::size_t bytes) override { m_line.receive_limit = bytes; }

 private:
  FakeLine& m_line;
};

}  // namespace naiad::fuzz
