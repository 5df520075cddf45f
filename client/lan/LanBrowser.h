// Looks for the servers of the local network: sends queries, collects answers (LanMessage.h).
//
// An answer counts if it repeats the nonce of this browser, has come through no router, and its sender is in
// a network of the interface that it came in by.
#pragma once

#include <chrono>
#include <cstdint>
#include <vector>

#include "client/lan/FoundServers.h"
#include "shared/net/lan/LanSocket.h"

namespace naiad {

/// Is this packet from a machine of the same link? `networks`: this machine's. What this machine sends itself
/// may come by loopback.
bool isFromLink(const LanPacket& packet, const std::vector<LanNetwork>& networks);

/// Never blocks. Thread: one at a time.
class LanBrowser {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// A query is sent again so soon after the first one, should that be lost, and then as often as this.
  static constexpr std::chrono::milliseconds kRepeat{400};
  static constexpr std::chrono::milliseconds kInterval{3000};
  /// All servers of a quiet network have answered by then.
  static constexpr std::chrono::milliseconds kPatience{800};
  /// Answers read in one call; the rest waits for the next.
  static constexpr int kTurn = 64;

  /// Opens the sockets. Where there are none, nothing is found.
  LanBrowser();

  /// Readable when answers wait.
  std::vector<int> descriptors() const;
  /// Send a query into each network, if one is due.
  void update(Time now);
  /// When update() next has something to do.
  Time nextQuery() const { return m_next_query; }
  /// Forget what was found, and ask again at once.
  void restart();
  /// Read answers. True if the list is another one now.
  bool receiveAnswers();

  const FoundServers& servers() const { return m_servers; }

 private:
  void sendQueries();
  bool takePacket(const LanPacket& packet);

  std::vector<LanSocket> m_sockets;
  std::vector<LanNetwork> m_networks;
  LanNonce m_nonce{};
  FoundServers m_servers;
  int m_sent = 0;       ///< rounds of queries since the beginning
  Time m_next_query{};  ///< now, at first
};

}  // namespace naiad
