// The paths of a session to its server: a stream, perhaps a second one beside it, and sealed datagrams.
//
// It knows how to send on each of them, not when (UpdateTiming) nor whether they are alive (StreamLiveness).
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

/// A second stream beside that of the session, where datagrams do not pass.
///
/// TCP delivers in order, so a lost packet holds up all that comes after it for a round trip and more. The
/// same snapshots and updates go on both streams; they seldom wait at the same time. What needs order
/// (chat, players, music) stays on the first.
///
/// Pure: the owner connects, and passes time in.
class SecondStream {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// Between two attempts, at first; doubled with each up to kLastPause, unless the one before lasted longer.
  static constexpr std::chrono::seconds kFirstPause{2};
  static constexpr std::chrono::seconds kLastPause{64};
  /// It is closed after this much silence, be it in answer to the hello or later.
  static constexpr std::chrono::seconds kMaxSilence{5};

  SecondStream() = default;
  ~SecondStream() { close(); }
  SecondStream(const SecondStream&) = delete;
  SecondStream& operator=(const SecondStream&) = delete;

  /// May one be opened now? True once for each attempt.
  bool takeAttempt(Time now);
  /// Say hello on `channel`; `on_snapshot` gets its snapshots once the server has accepted it. A server
  /// that sends anything else there loses this stream, nothing more.
  void start(std::unique_ptr<ReliableChannel> channel, const SessionOptions& options,
             std::function<void(std::string_view bytes)> on_snapshot);
  /// Close it if it is silent. Call now and then.
  void update(Time now);
  /// The server has accepted it.
  bool isOpen() const { return m_open; }
  /// A snapshot came, on either stream. True if it is among the last ones that did: it came on the other.
  bool isRepeat(std::string_view snapshot);
  /// Send a frame if it is open, and nothing waits on it.
  void send(std::string_view frame);
  /// Done with it; another one may be opened later.
  void close();

 private:
  void receive(std::string_view frame, Time now);

  std::unique_ptr<ReliableChannel> m_channel;
  std::function<void(std::string_view)> m_on_snapshot;
  bool m_open = false;
  /// Of the last snapshots; fewer than it takes until the 16 bits of a number repeat.
  std::array<std::size_t, 64> m_hashes{};
  std::size_t m_heard = 0;
  std::chrono::seconds m_pause = kFirstPause;
  Time m_next_attempt{};
  Time m_started{};
  Time m_last_heard{};
};

/// The datagrams of a session, at the client's end: a socket, and the seal on everything that goes through
/// it.
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
