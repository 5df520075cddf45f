// One session's datagrams on the server, opened and sealed, as the session sees them.
#pragma once

#include <cstdint>
#include <functional>

#include "shared/net/base/Channel.h"
#include "shared/net/datagram/DatagramKeys.h"

namespace naiad {

/// DatagramService has it where one thread does everything, NetworkThread where the sockets have their own.
class SealedChannel : public DatagramChannel {
 public:
  /// On the wire in front of what the client sends.
  virtual std::uint64_t id() const = 0;
  virtual AeadId aead() const = 0;
  /// Of the newest keys.
  virtual Epoch epoch() const = 0;
  /// Be told shortly before a packet is handed on, where several came at once, so that memory need not be
  /// waited for. This way never.
  virtual void expect(std::function<void()> on_soon) { (void)on_soon; }
  /// Likewise: room() and send() will be called soon.
  virtual void prefetch() const {}
  /// New keys, from another stream of the session. False if it has none to give, or for an epoch that is not
  /// newer.
  virtual bool renew(const ReliableChannel& stream, Epoch epoch) = 0;
};

}  // namespace naiad
