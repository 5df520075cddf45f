// What can be set on a TCP channel, whichever of these made it: TcpConnector, TcpListener or
// makeTcpChannel().
#pragma once

#include <chrono>
#include <cstddef>

#include "shared/net/base/Limits.h"

namespace naiad {

struct TcpOptions {
  /// Bytes (headers included) that may wait in the channel's own queue. One more and the channel ends with
  /// CloseReason::kOverflow. Counts what the kernel did not take yet, not what it holds.
  std::size_t send_cap = 1u << 20;
  /// The largest payload accepted from the peer at first, in bytes; setReceiveLimit() changes it.
  /// The default suits a server's end before login; a client wants kMaxServerFrame.
  std::size_t receive_limit = kMaxHelloFrame;
  /// How long close() goes on sending what is queued before it cuts the connection.
  std::chrono::milliseconds close_timeout{1000};
};

}  // namespace naiad
