// Logs the connections that are hung up on before TLS.
#pragma once

#include <asio/io_context.hpp>
#include <asio/ip/tcp.hpp>

#include "shared/net/base/TokenBucket.h"
#include "shared/net/stream/TcpListener.h"
#include "shared/program/ClientLog.h"

namespace naiad {

/// A flood of them must not fill the host's queue: what is left out is counted by the listener all the same.
class StreamRefusalLog {
 public:
  /// `home` runs the host's thread, where `log` is written; both outlive this.
  StreamRefusalLog(asio::io_context& home, ClientLog& log) : m_home(home), m_log(log) {}

  /// On the network thread.
  void note(const asio::ip::tcp::endpoint& peer, StreamRefusal why);

 private:
  asio::io_context& m_home;
  ClientLog& m_log;
  TokenBucket m_allowance;  ///< of the network thread
};

}  // namespace naiad
