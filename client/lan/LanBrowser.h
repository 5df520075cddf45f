// Finds the servers of the local network: sends queries and collects answers (LanMessage.h).
//
// An answer is accepted only if it repeats this browser's nonce, has passed no router, and comes from a
// network of the interface on which it arrived, or from this machine over loopback.
#pragma once

#include <chrono>
#include <cstdint>
#include <vector>

#include "client/lan/DiscoveredServers.h"
#include "shared/net/lan/LanSocket.h"

namespace naiad {

/// True if the packet comes from a machine on this network link. `networks`: networks of this machine, whose
/// own packets may come over loopback.
bool isFromLink(const LanPacket& packet, const std::vector<LanNetwork>& networks);

/// Never blocks. Use from one thread at a time.
class LanBrowser {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// The first query is repeated after kRetryDelay, in case it was lost. Then the interval is kInterval.
  static constexpr std::chrono::milliseconds kRetryDelay{400};
  static constexpr std::chrono::milliseconds kInterval{3000};
  /// Time after a query by which all servers of a quiet network have answered.
  static constexpr std::chrono::milliseconds kResponseTimeout{800};
  /// Maximum number of answers read from a socket in one call; the rest waits for the next call.
  static constexpr int kMaxAnswersPerCall = 64;

  /// Opens the sockets. If none can be opened, no server is found.
  LanBrowser();

  /// Returns the sockets' descriptors, which are readable when answers wait.
  std::vector<int> descriptors() const;
  /// Sends a query into each network, if one is due.
  void update(Time now);
  /// Returns when update() sends the next query.
  Time nextQuery() const { return m_next_query; }
  /// Clears the list; the next update() sends a query.
  void restart();
  /// Reads answers. Returns true if the list changed.
  bool receiveAnswers();

  const DiscoveredServers& servers() const { return m_servers; }

 private:
  void sendQueries();
  bool handlePacket(const LanPacket& packet);

  std::vector<LanSocket> m_sockets;
  std::vector<LanNetwork> m_networks;
  LanNonce m_nonce{};
  DiscoveredServers m_servers;
  int m_sent = 0;       ///< number of rounds of queries since the start or restart()
  Time m_next_query{};  ///< initially in the past, so that the first update() sends a query
};

}  // namespace naiad
