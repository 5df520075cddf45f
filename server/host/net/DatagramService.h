// All datagrams of a server: one socket, a gate against floods, and a sealed channel per session.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "host/net/SealedChannel.h"
#include "shared/net/base/Channel.h"
#include "shared/net/datagram/DatagramDemux.h"
#include "shared/net/datagram/DatagramSocket.h"
#include "shared/net/datagram/SealedLink.h"

namespace naiad {

/// Not thread-safe. Must outlive its channels.
class DatagramService {
 public:
  using Time = std::chrono::steady_clock::time_point;
  using Now = std::function<Time()>;
  using Random = std::function<std::uint64_t()>;

  /// `random` returns 64 unpredictable bits.
  DatagramService(std::unique_ptr<DatagramSocket> socket, Now now, Random random);
  ~DatagramService();

  /// Seals and opens one session's datagrams. Sends to the address of the newest authentic datagram.
  class Channel : public SealedChannel {
   public:
    ~Channel() override;
    void start(std::function<void(std::string_view packet)> on_packet) override;
    void send(std::string_view packet) override;
    std::optional<std::size_t> payloadBudget() const override {
      return m_link.path() ? m_link.payloadBudget() : std::nullopt;
    }
    std::string peerAddress() const override;

    bool renew(const KeyExporter& exporter, Epoch epoch);
    bool renew(const ReliableChannel& stream, Epoch epoch) override;
    std::uint64_t id() const override;
    AeadId aead() const override { return m_aead; }
    Epoch epoch() const override { return *m_link.epoch(); }
    const SealedLinkCounters& counters() const { return m_link.counters(); }

   private:
    friend class DatagramService;
    Channel(DatagramService& service, ConnectionId id, AeadId aead);
    void answerChallenges(Time now);
    void markUnvalidated();

    DatagramService& m_service;
    AeadId m_aead;
    SealedLink m_link;
    bool m_registered = false;   ///< true if it is in the service's gate
    bool m_unvalidated = false;  ///< true if it is in the service's m_unvalidated
    std::function<void(std::string_view)> m_on_packet;
  };

  /// Opens a channel with keys from the stream's exporter (DatagramKeys.h). Null if the exporter has no keys.
  std::unique_ptr<Channel> open(const KeyExporter& exporter, AeadId aead);
  /// Like open(exporter, aead), with a given id. Also null if the id is in use.
  std::unique_ptr<Channel> open(const KeyExporter& exporter, AeadId aead, ConnectionId id);
  /// Passes packets sent since the last call to the kernel, and control packets that are due to addresses
  /// that are not validated yet.
  void flush();
  /// True while an address is being challenged. Then call flush() regularly even if nothing is sent.
  bool hasUnvalidated() const { return !m_unvalidated.empty(); }
  /// Returns when the packet now being delivered was received; for use in callbacks of channels.
  Time received() const { return m_received; }
  /// The bound port.
  std::uint16_t port() const { return m_socket->localEndpoint().port; }
  const DatagramDemuxCounters& counters() const { return m_gate.counters(); }
  /// Bytes of all packets received, including refused ones.
  std::uint64_t bytesReceived() const { return m_bytes_received; }
  std::uint64_t bytesSent() const { return m_bytes_sent; }

 private:
  std::unique_ptr<DatagramSocket> m_socket;
  Now m_now;
  Random m_random;
  DatagramDemux m_gate;
  std::shared_ptr<SealScratch> m_scratch = std::make_shared<SealScratch>();
  Time m_received{};
  std::uint64_t m_bytes_received = 0;
  std::uint64_t m_bytes_sent = 0;
  std::vector<Channel*> m_unvalidated;  ///< channels whose address has not been validated yet
};

}  // namespace naiad
