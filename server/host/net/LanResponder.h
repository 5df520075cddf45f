// Answers clients that look for the servers of the local network (LanMessage.h).
//
// It has a thread and sockets of its own, so that whatever is sent there costs the game nothing but processor
// time, and little of that: no more than kTurn packets are read in kPause; the system drops the rest.
// Networks that come and go are noticed within kRefresh.
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

#include "shared/net/base/PerAddress.h"
#include "shared/net/base/TokenBucket.h"
#include "shared/net/lan/LanMessage.h"
#include "shared/net/lan/LanSocket.h"

namespace naiad {

/// When a server is found in the local network.
enum class LanMode {
  kOff,
  kAuto,  ///< in private networks (LanNetwork::is_private), unless it listens on loopback alone
  kOn,    ///< in all networks it listens in
};

/// Those of `networks` in which a server that listens on this numeric address ("::" hears IPv4 as well) is to
/// be found. With kAuto loopback counts only beside a private network.
std::vector<LanNetwork> answeredNetworks(const std::vector<LanNetwork>& networks, const std::string& address,
                                         LanMode mode);

/// What became of every packet: each is counted once.
struct LanCounters {
  std::uint64_t answered = 0;
  std::uint64_t routed = 0;   ///< the hop limit was not the full one
  std::uint64_t foreign = 0;  ///< not to the group, or not from a network in which the server is to be found
  std::uint64_t malformed = 0;  ///< no query
  std::uint64_t too_often = 0;  ///< over a limit
  std::uint64_t unsent = 0;     ///< the system refused to send the answer
};

/// Decides which queries of the local network a server answers, and with what. LanResponder has the sockets.
///
/// A packet is answered if it was sent to the group, has come through no router (hop limit 255), from an
/// address in a network of the interface it came in by where the server is to be found, is a query, and
/// neither its sender nor all together have asked too often. So an answer leaves the link never, and a forged
/// query costs its victim, a neighbour, 370 bytes for each 512 that the forger sends, a few times a second.
/// Not thread-safe. Time is passed in.
class LanQueryJudge {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// Answers a second, and at once: in all, and to an address (IPv6: /64). A client asks twice in its first
  /// second, in each family.
  static constexpr BucketRate kInAll{10, 10};
  static constexpr BucketRate kOfAPrefix{2, 4};

  /// `facts`: all but nonce and players.
  explicit LanQueryJudge(LanAnswer facts) : m_facts(std::move(facts)) {}

  /// In which queries are answered from now on: answeredNetworks().
  void setNetworks(std::vector<LanNetwork> networks) { m_networks = std::move(networks); }
  const std::vector<LanNetwork>& networks() const { return m_networks; }

  struct Reply {
    const LanNetwork* p_network;  ///< good until setNetworks()
    std::string bytes;
  };
  /// Nothing if the packet is not to be answered, which is counted. `players`: how many play.
  std::optional<Reply> judgePacket(const LanPacket& packet, std::size_t players, Time now);
  /// The last reply could not be sent.
  void noteUnsent();

  const LanCounters& counters() const { return m_counters; }

 private:
  const LanNetwork* findNetwork(const LanPacket& packet) const;

  LanAnswer m_facts;
  std::vector<LanNetwork> m_networks;
  PerAddress<TokenBucket> m_prefixes{256};
  TokenBucket m_all;
  LanCounters m_counters;
};

class LanResponder {
 public:
  static constexpr int kTurn = 64;  ///< packets, of each family
  static constexpr std::chrono::milliseconds kPause{50};
  static constexpr std::chrono::seconds kRefresh{5};

  /// Opens the sockets. Throws std::system_error if there is none of either family. `facts`: all but nonce
  /// and players. `address`: numeric, that the server listens on.
  LanResponder(LanAnswer facts, std::string address, LanMode mode);
  /// Stops.
  ~LanResponder();

  void start();
  /// End the thread. Nothing is answered after that.
  void stop();

  /// How many play. From any thread.
  void setPlayers(std::size_t players) { m_players.store(players, std::memory_order_relaxed); }
  /// Before start() or after stop().
  const LanCounters& counters() const { return m_judge.counters(); }

 private:
  void run();
  void refresh();
  bool serve(LanSocket& socket);
  void wait(bool sockets, std::chrono::milliseconds time);

  std::string m_address;
  LanMode m_mode;
  LanQueryJudge m_judge;
  std::vector<LanSocket> m_sockets;
  std::atomic<std::size_t> m_players = 0;
  std::atomic<bool> m_stopping = false;
  int m_wake = -1;  ///< an eventfd: written to stop
  std::thread m_thread;
};

}  // namespace naiad
