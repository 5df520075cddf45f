// All datagrams of a server: one socket, a gate against floods, and a sealed channel for each session.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "host/net/SealedChannel.h"
#include "shared/net/base/Channel.h"
#include "shared/net/datagram/DatagramGate.h"
#include "shared/net/datagram/DatagramSocket.h"
#include "shared/net/datagram/SealedLink.h"

namespace naiad {

/// Not thread-safe. Must outlive the channels it gives out.
class DatagramService {
 public:
  using Time = std::chrono::steady_clock::time_point;
  using Now = std::function<Time()>;
  using Random = std::function<std::uint64_t()>;

  /// `random`: 64 unpredictable bits.
  DatagramService(std::unique_ptr<DatagramSocket> socket, Now now, Random random);
  ~DatagramService();

  /// One session's datagrams, opened and sealed. They go to wherever the newest authentic one came from.
  class Channel : public SealedChannel {
   public:
    ~Channel() override;
    void start(std::function<void(std::string_view packet)> on_packet) override;
    void send(std::string_view packet) override;
    std::optional<std::size_t> room() const override { return m_link.path() ? m_link.room() : std::nullopt; }
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
    void noteUnproven();

    DatagramService& m_service;
    AeadId m_aead;
    SealedLink m_link;
    bool m_registered = false;  ///< with the gate
    bool m_unproven = false;    ///< in the service's list
    std::function<void(std::string_view)> m_on_packet;
  };

  /// Keys come from the stream's exporter (DatagramKeys.h). Null if it has none to give.
  std::unique_ptr<Channel> open(const KeyExporter& exporter, AeadId aead);
  /// The same with an id that was drawn already; null also if it is in use.
  std::unique_ptr<Channel> open(const KeyExporter& exporter, AeadId aead, ConnectionId id);
  /// Hand the kernel what was sent since the last call, and the link's own packets.
  void flush();
  /// Some address is being challenged: flush() is to be called now and then even if nothing is sent.
  bool isUnproven() const { return !m_unproven.empty(); }
  /// When the packet came that is being delivered; of use in callbacks of channels.
  Time received() const { return m_received; }
  /// The port bound to.
  std::uint16_t port() const { return m_socket->localEndpoint().port; }
  const DatagramGateCounters& counters() const { return m_gate.counters(); }
  /// Bytes of all packets that came, also those that were refused, and that were handed to the socket.
  std::uint64_t bytesReceived() const { return m_bytes_received; }
  std::uint64_t bytesSent() const { return m_bytes_sent; }

 private:
  std::unique_ptr<DatagramSocket> m_socket;
  Now m_now;
  Random m_random;
  DatagramGate m_gate;
  std::shared_ptr<SealScratch> m_scratch = std::make_shared<SealScratch>();
  Time m_received{};
  std::uint64_t m_bytes_received = 0;
  std::uint64_t m_bytes_sent = 0;
  std::vector<Channel*> m_unproven;  ///< channels whose address has not answered yet
};

}  // namespace naiad
