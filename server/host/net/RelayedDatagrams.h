// A session's datagrams of which the tick thread sees this, while keys and socket are the network thread's.
#pragma once

#include <functional>
#include <string>

#include "host/net/NetworkThread.h"
#include "host/net/SealedChannel.h"

namespace naiad {

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

}  // namespace naiad
