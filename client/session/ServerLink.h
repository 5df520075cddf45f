// The paths of a session to its server: a stream, perhaps a second stream, and encrypted datagrams.
//
// UpdateTiming decides when each of them is used; StreamLiveness tracks whether the server still answers.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "client/session/ServerMessages.h"
#include "client/session/SessionCounters.h"
#include "client/session/SessionOptions.h"
#include "shared/net/base/Channel.h"
#include "shared/net/datagram/DatagramSocket.h"
#include "shared/net/datagram/SealedLink.h"
#include "shared/net/stream/ReliableFrames.h"

namespace naiad {

/// A second stream, used in addition to the session's stream where datagrams do not pass.
///
/// TCP delivers in order, so a lost packet delays everything behind it for a round trip or more. Snapshots
/// and updates use both streams, which are seldom delayed at once. Messages that need order (chat,
/// players, music) use the first stream only.
///
/// The owner opens this stream. The time is a parameter or, in start() and for frames, SessionOptions::now.
class SecondStream {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// First pause before a retry; doubles up to kMaxRetryDelay while streams fail early.
  static constexpr std::chrono::seconds kFirstRetryDelay{2};
  static constexpr std::chrono::seconds kMaxRetryDelay{64};
  /// Silence of the server after which the stream is closed, after the hello or at any later time.
  static constexpr std::chrono::seconds kMaxSilence{5};

  SecondStream() = default;
  ~SecondStream() { close(); }
  SecondStream(const SecondStream&) = delete;
  SecondStream& operator=(const SecondStream&) = delete;

  /// Returns true, once for each attempt, if a stream may be opened now.
  bool tryBeginAttempt(Time now);
  /// Sends the hello on `channel`. Once the server has accepted the stream, `on_snapshot` is called with each
  /// snapshot on it. If the server sends anything else on it, only this stream is closed.
  void start(std::unique_ptr<ReliableChannel> channel, const SessionOptions& options,
             std::function<void(std::string_view bytes)> on_snapshot);
  /// Closes the stream if it is silent. Call about once a second or more often.
  void update(Time now);
  /// True if the server has accepted the stream.
  bool isOpen() const { return m_open; }
  /// Call for each snapshot on either stream. True if it is among the last 64: the other stream carried it.
  bool isDuplicate(std::string_view snapshot);
  /// Sends a frame if the stream is open and has nothing unsent.
  void send(std::string_view frame);
  /// Closes the stream; another one may be opened later.
  void close();

 private:
  void receive(std::string_view frame, Time now);

  std::unique_ptr<ReliableChannel> m_channel;
  std::function<void(std::string_view)> m_on_snapshot;
  bool m_open = false;
  /// Hashes of the last snapshots. Must be fewer than 65,536, because snapshots that far apart may be equal.
  std::array<std::size_t, 64> m_hashes{};
  std::size_t m_snapshot_count = 0;
  std::chrono::seconds m_retry_delay = kFirstRetryDelay;
  Time m_next_attempt{};
  Time m_started{};
  Time m_last_received{};
};

/// Client end of a session's datagrams: a socket, and the encryption of everything sent and received.
class SealedDatagrams : public DatagramChannel {
 public:
  using Time = std::chrono::steady_clock::time_point;
  using Now = std::function<Time()>;

  /// `server`: the server's UDP endpoint. `id`: the connection id in its welcome.
  SealedDatagrams(std::unique_ptr<DatagramSocket> socket, const Endpoint& server, ConnectionId id, Now now,
                  SealLimits limits = {});

  /// Derives keys from the newest stream (DatagramKeys.h). False on failure or if the epoch is not newer.
  bool startEpoch(const KeyExporter& exporter, AeadId aead, Epoch epoch);

  void start(std::function<void(std::string_view packet)> on_packet) override;
  void send(std::string_view packet) override;
  std::optional<std::size_t> payloadBudget() const override { return m_link.payloadBudget(); }
  std::string peerAddress() const override { return toString(m_server); }
  /// Measures the round trip with the next packet; popRoundTrip() returns the result.
  void ping() { m_link.ping(); }
  std::optional<LinkPing::Millis> popRoundTrip() { return m_link.popRoundTrip(); }
  /// Returns true, once for each epoch, when a key nears its limit, so that another stream is needed.
  bool popNewEpochDue();
  /// Continues from another port, because the network may have changed.
  void reopen();

 private:
  std::unique_ptr<DatagramSocket> m_socket;
  Endpoint m_server;
  Now m_now;
  SealedLink m_link;
  std::optional<Epoch> m_reported_epoch;  ///< newest epoch for which popNewEpochDue() returned true
};

namespace wire {
class ClientMessage;
}

class ServerLink {
 public:
  using Time = std::chrono::steady_clock::time_point;
  using OnSnapshot = std::function<void(std::string_view bytes)>;

  /// Unsent bytes above which the stream counts as stuck; more inputs would only burden the server later.
  static constexpr std::size_t kMaxUnsent = std::size_t{64} * 1024;

  /// Sends the hello on the connected channel. `counters` must outlive the link.
  ServerLink(std::unique_ptr<ReliableChannel> channel, const SessionOptions& options,
             SessionCounters& counters);
  ServerLink(const ServerLink&) = delete;
  ServerLink& operator=(const ServerLink&) = delete;

  const SessionOptions& options() const { return m_options; }
  Time now() const { return m_options.now(); }

  bool hasStream() const { return m_channel != nullptr; }
  bool ownsStream(const ReliableChannel* channel) const { return m_channel.get() == channel; }
  /// Takes over the stream of `other`; closes this link's second stream.
  void adoptStream(ServerLink& other);
  /// Call when the stream has ended, unless closeStreams() closed it. Also closes the second stream.
  void dropStream();
  /// Closes the streams; queued data is still sent.
  void closeStreams();
  bool isStalled() const { return hasStream() && m_channel->unsentBytes() > kMaxUnsent; }
  /// Sends a message on the stream, if there is one.
  void send(const wire::ClientMessage& message);
  /// Sends a message on the stream, and again on later streams until it is acknowledged. Returns false
  /// and does not send it if too much is unacknowledged.
  bool sendReliable(wire::ClientMessage& message);
  void acknowledgeReliable(std::uint32_t number) { m_unacknowledged.acknowledge(number); }
  void resendReliable();
  /// Sends an update on the stream, and on the second one if that is open and has nothing unsent.
  void sendUpdate(std::string bytes);

  SecondStream& second() { return m_second; }
  bool hasSecondStream() const { return m_second.isOpen(); }
  void startSecond(std::unique_ptr<ReliableChannel> channel, const std::string& resume_token,
                   OnSnapshot on_snapshot);

  bool hasDatagrams() const { return m_datagrams != nullptr; }
  /// Opens a datagram socket to the stream's peer address. Returns false if datagrams are off or impossible.
  bool openDatagrams(const WelcomeMessage& welcome, OnSnapshot on_snapshot);
  void closeDatagrams() { m_datagrams.reset(); }
  /// Derives new keys for existing datagrams from a new stream, and sends from another port.
  void renewDatagrams(const WelcomeMessage& welcome);
  /// Requires hasDatagrams(). `ping`: measure the round trip with this datagram.
  void sendDatagram(const std::string& bytes, bool ping);
  std::optional<LinkPing::Millis> popRoundTrip() { return m_datagrams->popRoundTrip(); }
  /// Like SealedDatagrams::popNewEpochDue(); false without datagrams.
  bool popNewEpochDue() { return m_datagrams != nullptr && m_datagrams->popNewEpochDue(); }

 private:
  void sendFrame(const std::string& frame);
  KeyExporter exporter() const;

  SessionOptions m_options;
  SessionCounters& m_counters;
  std::unique_ptr<ReliableChannel> m_channel;
  SecondStream m_second;
  std::unique_ptr<SealedDatagrams> m_datagrams;
  ReliableFrameSender m_unacknowledged;
};

}  // namespace naiad
