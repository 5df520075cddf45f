// A stream of which the tick thread sees this, while its socket is the network thread's.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "host/net/NetworkThread.h"
#include "shared/net/base/Channel.h"

namespace naiad {

/// Thread: the one that ticks. Callbacks come from NetworkThread::serve(), frames leave with its flush().
/// unsentBytes() counts the bytes on the way to the network thread and those that it had unsent at its last
/// count, which it makes every few milliseconds while there are any.
/// exportSecret() gives nothing: keys are made over there (NetworkThread::openDatagrams).
class RelayedStream : public ReliableChannel {
 public:
  RelayedStream(NetworkThread& network, NetworkThread::StreamEnd& end);
  ~RelayedStream() override;
  RelayedStream(const RelayedStream&) = delete;
  RelayedStream& operator=(const RelayedStream&) = delete;

  void start(Callbacks callbacks) override;
  void send(std::string_view frame) override;
  std::size_t unsentBytes() const override;
  void close() override;
  std::string peerAddress() const override { return m_end.peer; }
  void setReceiveLimit(std::size_t bytes) override;

 private:
  friend class NetworkThread;

  /// Bytes that the network thread has not taken over yet.
  std::size_t inTransit() const { return static_cast<std::size_t>(m_given - m_end.taken); }
  void deliver(std::string_view frame);
  void reportEnd(CloseReason reason);

  NetworkThread& m_network;
  NetworkThread::StreamEnd& m_end;
  std::shared_ptr<Callbacks> m_callbacks;  ///< shared with the call that is running
  std::uint64_t m_given = 0;               ///< bytes, ever
  mutable bool m_idle = false;             ///< nothing was given since nothing was unsent
  bool m_closed = false;                   ///< by us, or it overflowed
};

}  // namespace naiad
