// The paths of a session to its server: a stream, perhaps a second one beside it, and sealed datagrams.
//
// It knows how to send on each of them, not when (UpdateTiming) nor whether they are alive (StreamLiveness).
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "client/session/SecondStream.h"
#include "client/session/ServerMessages.h"
#include "client/session/SessionCounters.h"
#include "client/session/SessionOptions.h"
#include "shared/net/base/Channel.h"
#include "shared/net/datagram/DatagramSocket.h"
#include "shared/net/datagram/SealedLink.h"
#include "shared/net/stream/ReliableFrames.h"

namespace naiad {

/// The datagrams of a session, at the client's end: a socket, and the seal on everything that goes through it.
class SealedDatagrams : public DatagramChannel {
 public:
  using Time = std::chrono::steady_clock::time_point;
  using Now = std::function<Time()>;

  /// `server`: where the server receives datagrams. `id`: from its welcome.
  SealedDatagrams(std::unique_ptr<DatagramSocket> socket, const Endpoint& server, ConnectionId id, Now now,
                  SealLimits limits = {});

  /// Keys from the session's newest stream (DatagramKeys.h). False if it gives none, or the epoch is not
  /// newer.
  bool startEpoch(const KeyExporter& exporter, AeadId aead, Epoch epoch);

  void start(std::function<void(std::string_view packet)> on_packet) override;
  void send(std::string_view packet) override;
  std::optional<std::size_t> room() const override { return m_link.room(); }
  std::string peerAddress() const override { return toString(m_server); }
  /// Measure the round trip with the next packet; takeRoundTrip() has the result.
  void ping() { m_link.ping(); }
  std::optional<LinkPing::Millis> takeRoundTrip() { return m_link.takeRoundTrip(); }
  /// True once for each epoch, when a key of it nears its limit: it is time for another stream.
  bool takeNewEpochDue();
  /// The network may have changed: go on from another port.
  void reopen();

 private:
  std::unique_ptr<DatagramSocket> m_socket;
  Endpoint m_server;
  Now m_now;
  SealedLink m_link;
  std::optional<Epoch> m_left_epoch;  ///< takeNewEpochDue() has returned true for it
};

namespace wire {
class ClientMessage;
}

class ServerLink {
 public:
  using Time = std::chrono::steady_clock::time_point;
  using OnSnapshot = std::function<void(std::string_view bytes)>;

  /// With this much unsent the stream is stuck; more inputs would only make the server busy later.
  static constexpr std::size_t kMaxUnsent = std::size_t{64} * 1024;

  /// Says hello on the connected channel. `counters` must outlive the link.
  ServerLink(std::unique_ptr<ReliableChannel> channel, const SessionOptions& options,
             SessionCounters& counters);
  ServerLink(const ServerLink&) = delete;
  ServerLink& operator=(const ServerLink&) = delete;

  const SessionOptions& options() const { return m_options; }
  Time now() const { return m_options.now(); }

  bool hasStream() const { return m_channel != nullptr; }
  bool ownsStream(const ReliableChannel* channel) const { return m_channel.get() == channel; }
  /// Use the stream of `other`; a second stream ends.
  void takeStream(ServerLink& other);
  /// The stream has ended by itself.
  void dropStream();
  /// Close the streams; what is queued is still sent.
  void closeStreams();
  bool isStuck() const { return hasStream() && m_channel->unsentBytes() > kMaxUnsent; }
  /// Send on the stream, if there is one.
  void send(const wire::ClientMessage& message);
  /// Send on the stream, and again on later ones until acknowledged. False if too much is unacknowledged.
  bool sendReliable(wire::ClientMessage& message);
  void acknowledgeReliable(std::uint32_t number) { m_unacknowledged.acknowledge(number); }
  void resendReliable();
  /// Send an update on the stream, and on the second one.
  void sendUpdate(std::string bytes);

  SecondStream& second() { return m_second; }
  bool hasSecondStream() const { return m_second.isOpen(); }
  void startSecond(std::unique_ptr<ReliableChannel> channel, const std::string& resume_token,
                   OnSnapshot on_snapshot);

  bool hasDatagrams() const { return m_datagrams != nullptr; }
  /// Open a socket to the address that the stream goes to. False if that cannot be, or is not wanted.
  bool openDatagrams(const WelcomeMessage& welcome, OnSnapshot on_snapshot);
  void closeDatagrams() { m_datagrams.reset(); }
  /// Take keys for existing datagrams from a new stream, and send from another port.
  void renewDatagrams(const WelcomeMessage& welcome);
  /// With datagrams only. `ping`: measure the round trip with this one.
  void sendDatagram(const std::string& bytes, bool ping);
  std::optional<LinkPing::Millis> takeRoundTrip() { return m_datagrams->takeRoundTrip(); }
  /// True once for each epoch, when a key of it nears its limit: another stream is needed for new keys.
  bool takeNewEpochDue() { return m_datagrams != nullptr && m_datagrams->takeNewEpochDue(); }

 private:
  void sendFrame(const std::string& frame);
  KeyExporter exporter() const;

  SessionOptions m_options;
  SessionCounters& m_counters;
  std::unique_ptr<ReliableChannel> m_channel;
  SecondStream m_second;
  std::unique_ptr<SealedDatagrams> m_datagrams;
  ReliableFrames m_unacknowledged;
};

}  // namespace naiad
