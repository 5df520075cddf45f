// One session's datagrams on the server, sealed and opened, as the session sees them.
#pragma once

#include <cstdint>

#include "shared/net/base/Channel.h"
#include "shared/net/datagram/DatagramKeys.h"

namespace naiad {

/// Implemented by DatagramService::Channel (on one thread) and RelayedDatagrams (sockets on their own
/// thread).
class SealedChannel : public DatagramChannel {
 public:
  /// The connection id in the header of the client's datagrams.
  virtual std::uint64_t id() const = 0;
  virtual AeadId aead() const = 0;
  /// Epoch of the newest keys.
  virtual Epoch epoch() const = 0;
  /// Switches to keys from another stream of the session. False if that has no keys or `epoch` is not newer.
  virtual bool renew(const ReliableChannel& stream, Epoch epoch) = 0;
};

}  // namespace naiad
