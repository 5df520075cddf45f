// Answers clients that search the local network for servers (LanMessage.h).
//
// It has its own thread and sockets, and reads at most kMaxPackets packets per kPollInterval and address
// family; the system drops further ones. So LAN packets cost the game little processor time and nothing else.
// It notices new networks within kRefreshInterval.
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "shared/net/base/PrefixLruMap.h"
#include "shared/net/base/TokenBucket.h"
#include "shared/net/lan/LanMessage.h"
#include "shared/net/lan/LanSocket.h"

namespace naiad {

/// Controls where a server can be found in the local network.
enum class LanMode {
  kOff,
  kAuto,  ///< in private networks (LanNetwork::is_private), unless it listens only on loopback
  kOn,    ///< in all networks that it listens on
};

/// Returns the networks of `networks` in which a server that listens on this numeric address can be found.
/// "::" includes IPv4. With kAuto, loopback is included only if a private network is.
std::vector<LanNetwork> answeredNetworks(const std::vector<LanNetwork>& networks, const std::string& address,
                                         LanMode mode);

/// Outcomes of received packets. Each packet is counted once.
struct LanCounters {
  std::uint64_t answered = 0;
  std::uint64_t routed = 0;  ///< packets whose hop limit shows that they passed a router
  std::uint64_t foreign =
      0;  ///< not sent to the group, or not from a network in which the server can be found
  std::uint64_t malformed = 0;     ///< not a query
  std::uint64_t rate_limited = 0;  ///< queries above a rate limit
  std::uint64_t unsent = 0;        ///< the system refused to send the answer
};

/// Decides which queries from the local network a server answers, and how. LanResponder owns the sockets.
///
/// A packet is answered if it was sent to the group, passed no router (hop limit 255), came from an address
/// in an answered network of its interface, is a query, and is within the rate limits of its sender and of
/// all senders. So answers never leave the link, and a forged query sends at most 370 bytes to its victim, a
/// neighbour, per 512 bytes of the forger, a few times a second. Not thread-safe. Time is a parameter.
class LanQueryFilter {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// Rate limits of answers, in total and per address (IPv6: /64). A client begins with two queries per
  /// family.
  static constexpr BucketRate kTotalRate{10, 10};
  static constexpr BucketRate kPrefixRate{2, 4};

  /// `facts`: the answer, except for its nonce and its number of players.
  explicit LanQueryFilter(LanAnswer facts) : m_facts(std::move(facts)) {}

  /// Sets the networks in which queries are answered: answeredNetworks().
  void setNetworks(std::vector<LanNetwork> networks) { m_networks = std::move(networks); }
  const std::vector<LanNetwork>& networks() const { return m_networks; }

  struct Reply {
    const LanNetwork* p_network;  ///< valid until setNetworks()
    std::string bytes;
  };
  /// Returns nullopt if the packet gets no answer; the reason is counted. `players`: number of players.
  std::optional<Reply> filter(const LanPacket& packet, std::size_t players, Time now);
  /// Call if the last reply could not be sent.
  void countUnsent();

  const LanCounters& counters() const { return m_counters; }

 private:
  const LanNetwork* findNetwork(const LanPacket& packet) const;

  LanAnswer m_facts;
  std::vector<LanNetwork> m_networks;
  PrefixLruMap<TokenBucket> m_prefixes{256};
  TokenBucket m_all;
  LanCounters m_counters;
};

class LanResponder {
 public:
  static constexpr int kMaxPackets = 64;  ///< maximum packets per kPollInterval and address family
  static constexpr std::chrono::milliseconds kPollInterval{50};
  static constexpr std::chrono::seconds kRefreshInterval{5};

  /// Opens the sockets. `facts`: the answer, except for its nonce and its number of players. `address`: the
  /// numeric address on which the server listens. Throws std::system_error if no socket can be opened.
  LanResponder(LanAnswer facts, std::string address, LanMode mode);
  /// Calls stop().
  ~LanResponder();

  void start();
  /// Ends the thread. Nothing is answered afterwards.
  void stop();

  /// Sets the number of players. Any thread.
  void setPlayers(std::size_t players) { m_players.store(players, std::memory_order_relaxed); }
  /// Call before start() or after stop().
  const LanCounters& counters() const { return m_filter.counters(); }

 private:
  void run();
  void refresh();
  bool serve(LanSocket& socket);
  void wait(bool sockets, std::chrono::milliseconds time);

  std::string m_address;
  LanMode m_mode;
  LanQueryFilter m_filter;
  std::vector<LanSocket> m_sockets;
  std::atomic<std::size_t> m_players = 0;
  std::atomic<bool> m_stopping = false;
  int m_wake = -1;  ///< an eventfd; stop() writes to it
  std::thread m_thread;
};

}  // namespace naiad
