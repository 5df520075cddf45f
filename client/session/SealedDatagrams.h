// The datagrams of a session, at the client's end: a socket, and the seal on everything that goes through it.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "shared/net/base/Channel.h"
#include "shared/net/datagram/DatagramSocket.h"
#include "shared/net/datagram/SealedLink.h"

namespace naiad {

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

}  // namespace naiad
