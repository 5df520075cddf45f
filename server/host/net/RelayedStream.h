// The tick thread's ends of streams and datagrams whose sockets belong to the network thread.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "host/net/NetworkThread.h"
#include "host/net/SealedChannel.h"
#include "shared/net/base/Channel.h"

namespace naiad {

/// A session's datagrams as the tick thread sees them; keys and socket belong to the network thread. Call on
/// the tick thread. Packets arrive in NetworkThread::serve() and leave with its flush(). payloadBudget() is
/// the value after the network thread's last packet. If a stream ends before it provides keys, the previous
/// keys stay in use; without previous keys, payloadBudget() returns nullopt.
class RelayedDatagrams : public SealedChannel {
 public:
  RelayedDatagrams(NetworkThread& network, NetworkThread::NetworkSideDatagrams& end, Epoch epoch);
  ~RelayedDatagrams() override;
  RelayedDatagrams(const RelayedDatagrams&) = delete;
  RelayedDatagrams& operator=(const RelayedDatagrams&) = delete;

  void start(std::function<void(std::string_view packet)> on_packet) override;
  void send(std::string_view packet) override;
  std::optional<std::size_t> payloadBudget() const override;
  /// Returns a label: the address may change with every packet, and only the network thread knows it.
  std::string peerAddress() const override { return "datagrams " + std::to_string(m_end.id); }

  std::uint64_t id() const override { return m_end.connection; }
  AeadId aead() const override { return m_end.aead; }
  Epoch epoch() const override { return m_epoch; }
  bool renew(const ReliableChannel& stream, Epoch epoch) override;

 private:
  friend class NetworkThread;

  NetworkThread& m_network;
  NetworkThread::NetworkSideDatagrams& m_end;
  Epoch m_epoch;
  std::function<void(std::string_view)> m_on_packet;
};

/// Call on the tick thread. NetworkThread::serve() calls the callbacks; frames leave with its flush().
/// unsentBytes() is the sum of the bytes on the way to the network thread and of those that were unsent there
/// at its last count, every few milliseconds. exportSecret() returns nothing, because the network thread
/// makes the keys (NetworkThread::openDatagrams).
class RelayedStream : public ReliableChannel {
 public:
  RelayedStream(NetworkThread& network, NetworkThread::NetworkSideStream& end);
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

  /// Bytes that the network thread has not received yet.
  std::size_t inTransit() const { return static_cast<std::size_t>(m_bytes_passed - m_end.taken); }
  void deliver(std::string_view frame);
  void reportEnd(CloseReason reason);

  NetworkThread& m_network;
  NetworkThread::NetworkSideStream& m_end;
  std::shared_ptr<Callbacks> m_callbacks;  ///< shared with a running callback
  std::uint64_t m_bytes_passed = 0;        ///< total bytes passed to the network thread
  mutable bool m_idle = false;             ///< true if unsentBytes() was 0, and nothing was passed since
  bool m_closed = false;                   ///< true if this end closed the stream, or it has ended
};

}  // namespace naiad
