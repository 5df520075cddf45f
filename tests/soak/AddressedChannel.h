// A stream in virtual time with the peer's address, to which a client also sends its datagrams.
#pragma once

#include <memory>
#include <string>
#include <utility>

#include "shared/net/base/Channel.h"

namespace naiad::soak {

class AddressedChannel : public ReliableChannel {
 public:
  AddressedChannel(std::unique_ptr<ReliableChannel> channel, std::string peer)
      : m_channel(std::move(channel)), m_peer(std::move(peer)) {}

  void start(Callbacks callbacks) override { m_channel->start(std::move(callbacks)); }
  void send(std::string_view frame) override { m_channel->send(frame); }
  std::size_t unsentBytes() const override { return m_channel->unsentBytes(); }
  void close() override { m_channel->close(); }
  std::string peerAddress() const override { return m_peer; }
  void setReceiveLimit(std::size_t bytes) override { m_channel->setReceiveLimit(bytes); }
  std::string exportSecret(std::string_view label, std::string_view context,
                           std::size_t bytes) const override {
    return m_channel->exportSecret(label, context, bytes);
  }

 private:
  std::unique_ptr<ReliableChannel> m_channel;
  std::string m_peer;
};

}  // namespace naiad::soak
