// One session's datagrams on the server, opened and sealed, as the session sees them.
#pragma once

#include <cstdint>

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
  /// New keys, from another stream of the session. False if it has none to give, or for an epoch that is not
  /// newer.
  virtual bool renew(const ReliableChannel& stream, Epoch epoch) = 0;
};

}  // namespace naiad
