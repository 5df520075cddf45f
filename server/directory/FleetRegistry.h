// The servers of a fleet, known by their heartbeats on the bus, and the choice of a server for a player.
//
// Heartbeats are untrusted: they are parsed strictly (BusPayloads.h), must have the id in their subject, and
// expire.
#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "host/fleet/Bus.h"
#include "shared/fleet/BusPayloads.h"
#include "shared/net/base/TokenBucket.h"

namespace naiad {

// The list of servers for the web, read by dfclient --list-url: an array of objects like those that dfserver
// --status-file writes.

/// Maximum number of servers in a list, so that its text stays below the 1 MiB that clients read.
inline constexpr std::size_t kMaxListedServers = 500;

/// Returns the link to a server, or to a room of it; empty if its address or key is unknown.
std::string linkOf(const Presence& server, const std::string& room = "");

/// Returns the open servers that have a link as an ASCII JSON array (RFC 8259), one object per line. If there
/// are more than kMaxListedServers, lists those with the most free places. Omits the rooms of further servers
/// once the text has 500 kB.
std::string serverListText(std::vector<Presence> servers);

struct FleetCounters {
  std::uint64_t heartbeats = 0;     ///< valid heartbeats
  std::uint64_t unreadable = 0;     ///< heartbeats that cannot be parsed
  std::uint64_t wrong_subject = 0;  ///< heartbeats with another id than their subject
  std::uint64_t over_limit = 0;     ///< heartbeats of new servers while kMaxServers are known
  std::uint64_t expired = 0;        ///< servers removed because their heartbeats stopped
};

/// Not thread-safe. Time is passed in.
class FleetRegistry {
 public:
  using Time = std::chrono::steady_clock::time_point;

  static constexpr std::size_t kMaxServers = 4096;

  /// `interval`: heartbeat interval of the servers. A server without one for three intervals expires.
  explicit FleetRegistry(std::chrono::milliseconds interval = Presence::kInterval)
      : m_timeout(3 * interval) {}

  /// Handles a heartbeat. Returns true if it is valid and the server is new.
  bool handleHeartbeat(const std::string& subject, std::string_view payload, Time now);
  /// Removes the servers whose heartbeats have stopped. Returns their ids.
  std::vector<std::string> removeExpired(Time now);
  /// Restarts the timeouts of the servers that were heard less than `most` ago. Call while the bus is down or
  /// loses messages, because then silence does not show that a server has ended.
  void excuseSilence(Time now, std::chrono::minutes most);

  /// A player's requirements.
  struct PlayerRequest {
    std::string game;            ///< name of a game; empty: any
    std::uint32_t protocol = 0;  ///< protocol version of the client
    std::string not_id = {};     ///< the server that redirects the player; excluded
    std::string room = {};       ///< name of a room; empty: any
  };
  /// The target of a redirect.
  struct Assignment {
    const Presence* p_server = nullptr;  ///< null: none
    std::string room = {};               ///< room of the server; empty: the server has no named rooms
    explicit operator bool() const { return p_server != nullptr; }
  };
  /// Chooses a server for a player and reserves a place on it until the server has counted the player. The
  /// server must fit the request, be open, have no password, a known address and key, an unprivileged port
  /// and a free place. Prefers, of those less than three quarters full, the one with the most players,
  /// because players look for company; if there is none, the one with the most free places. On a server with
  /// rooms, chooses a room of the requested game by the same rule, the requested room, or, without a request,
  /// the first room with a free place.
  Assignment choose(const PlayerRequest& request);

  /// Like choose(), for players of a server that is nearly full: chooses the server with the most free
  /// places, and reserves nothing.
  Assignment leastLoaded(const PlayerRequest& request) const;
  /// True if any server fits the request, even if it is full or closed.
  bool hasMatch(const PlayerRequest& request) const;
  /// Returns the servers that are at least three quarters full, or closed.
  std::vector<Presence> nearlyFull() const;

  std::vector<Presence> servers() const;
  std::size_t size() const { return m_servers.size(); }
  const FleetCounters& counters() const { return m_counters; }

 private:
  /// Numbers of players that were redirected to a server since its last heartbeat, and in the two intervals
  /// before it. They count as present, because the server may not have counted them yet.
  using RedirectCounts = std::array<std::uint32_t, 3>;
  /// The load of a server or a room.
  struct Load {
    std::uint32_t taken = 0;
    std::uint32_t places = 0;
    std::uint32_t free() const { return places - std::min(taken, places); }
    bool isBelowThreeQuarters() const { return taken < places / 4 * 3; }
    /// True if a server or room with this load is the better choice for a player looking for company.
    bool isBetterThan(const Load& other) const;
  };
  struct RegisteredServer {
    Presence presence;
    Time heard{};
    Time excused{};  ///< the silence before this time does not count
    RedirectCounts sent{};
    std::map<std::string, RedirectCounts> sent_to;  ///< key: room
    Load load() const;
    Load load(const PresenceRoom& room) const;
  };
  static bool fits(const RegisteredServer& entry, const PlayerRequest& request);
  /// Returns the room to choose for the request; null if no fitting room has a free place.
  static const PresenceRoom* findRoom(const RegisteredServer& entry, const PlayerRequest& request);
  /// Returns the load of the server, or of its room, for the request; nullopt if it does not fit or is full.
  static std::optional<Load> loadFor(const RegisteredServer& entry, const PlayerRequest& request);
  static Assignment assignmentOn(const RegisteredServer& entry, const PlayerRequest& request);

  std::chrono::milliseconds m_timeout;
  std::map<std::string, RegisteredServer> m_servers;
  FleetCounters m_counters;
};

/// Lowest port to which players are redirected, because lower ones belong to system services.
inline constexpr std::uint16_t kMinFleetPort = 1024;

/// Updates a FleetRegistry with the messages of the bus. Not thread-safe. Time is passed in.
class FleetMonitor {
 public:
  using Time = FleetRegistry::Time;

  /// Longest outage of the bus during which the list stays unchanged: the servers still run, and players
  /// still find them.
  static constexpr std::chrono::minutes kMaxBusOutage{10};
  /// Longest silence of a server while the bus loses messages, or while this process does not run, such as
  /// when its machine is suspended.
  static constexpr std::chrono::minutes kMaxBusLoss{3};
  /// Rate limit of log lines about servers that join or leave; needed because ids may be faked.
  static constexpr BucketRate kLogRate{5, 100};

  /// `bus` must subscribe to presence. `interval`: heartbeat interval of the servers.
  FleetMonitor(std::unique_ptr<Bus> bus, std::function<void(const std::string& line)> log,
               std::chrono::milliseconds interval = Presence::kInterval);

  /// Handles new messages and removes silent servers. Call it several times per heartbeat interval.
  void update(Time now);

  FleetRegistry& servers() { return m_servers; }
  const FleetRegistry& servers() const { return m_servers; }
  Bus& bus() { return *m_bus; }

 private:
  void logLimited(const std::string& line, Time now);

  std::unique_ptr<Bus> m_bus;
  std::function<void(const std::string& line)> m_log;
  const std::chrono::milliseconds m_interval;  ///< heartbeat interval of the servers
  FleetRegistry m_servers;
  std::uint64_t m_lost = 0;  ///< BusCounters::lost in the last update()
  Time m_updated{};          ///< time of the last update()
  TokenBucket m_log_limit;
  std::uint64_t m_dropped_lines = 0;
};

}  // namespace naiad
