// A stream of which the tick thread sees this, while its socket is the network thread's.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "host/net/NetworkThread.h"
#include "host/net/SealedChannel.h"
#include "shared/net/base/Channel.h"

namespace naiad {

/// A session's datagrams of which the tick thread sees this, while keys and socket are the network thread's.
/// Thread: the one that ticks. Packets come from NetworkThread::serve(), and leave with its flush(). room()
/// is what it was when the network thread last sealed or opened one. A stream that ends before it could give
/// keys leaves the ones before in use, or none: then there is no room, ever.
class RelayedDatagrams : public SealedChannel {
 public:
  RelayedDatagrams(NetworkThread& network, NetworkThread::DatagramsEnd& end, Epoch epoch);
  ~RelayedDatagrams() override;
  RelayedDatagrams(const RelayedDatagrams&) = delete;
  RelayedDatagrams& operator=(const RelayedDatagrams&) = delete;

  void start(std::function<void(std::string_view packet)> on_packet) override;
  void send(std::string_view packet) override;
  std::optional<std::size_t> room() const override;
  /// The address may change with every packet, and is the network thread's to know.
  std::string peerAddress() const override { return "datagrams " + std::to_string(m_end.id); }

  std::uint64_t id() const override { return m_end.connection; }
  AeadId aead() const override { return m_end.aead; }
  Epoch epoch() const override { return m_epoch; }
  bool renew(const ReliableChannel& stream, Epoch epoch) override;

 private:
  friend class NetworkThread;

  NetworkThread& m_network;
  NetworkThread::DatagramsEnd& m_end;
  Epoch m_epoch;
  std::function<void(std::string_view)> m_on_packet;
};

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
