// The servers that have said on the bus that they are there, and which of them a player is sent to.
//
// What they say may be wrong in any way: it is read strictly (BusPayloads.h), counts only under the name that
// its subject has, and ends by itself.
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

// A list of servers for the web, as dfclient --list-url reads it: an array of what dfserver --status-file
// writes.

/// Servers in a list; with all of them it stays below the 1 MiB that a client takes.
inline constexpr std::size_t kMaxListedServers = 500;

/// The link to a server, or to a room of it; empty if it is not known where it is, or which key it has.
std::string linkOf(const Presence& server, const std::string& room = "");

/// A JSON array (RFC 8259), one object to a line, ASCII: the servers that let players in and have a link. If
/// there are too many, those with most free places; rooms are left out of what would be too long with them.
std::string serverListText(std::vector<Presence> servers);

struct FleetCounters {
  std::uint64_t heard = 0;       ///< that a server is there
  std::uint64_t unreadable = 0;  ///< what no server writes
  std::uint64_t foreign = 0;     ///< under another name than its own
  std::uint64_t crowded = 0;     ///< of servers beyond the most
  std::uint64_t expired = 0;     ///< servers that said nothing more
};

/// Not thread-safe. Time is passed in.
class FleetList {
 public:
  using Time = std::chrono::steady_clock::time_point;

  static constexpr std::size_t kMaxServers = 4096;

  /// `interval`: between two times that a server says it is there; silent for three of them, it is gone.
  explicit FleetList(std::chrono::milliseconds interval = Presence::kInterval) : m_life(3 * interval) {}

  /// What was said under this subject. True if the server is new.
  bool put(const std::string& subject, std::string_view payload, Time now);
  /// Remove the servers whose time is over; their names.
  std::vector<std::string> removeSilent(Time now);
  /// The bus was gone: silence so far means nothing.
  void forgiveSilence(Time now);

  /// What a player wants, and what cannot be theirs.
  struct Wish {
    std::string game;            ///< empty: any
    std::uint32_t protocol = 0;  ///< that the client speaks
    std::string not_id = {};     ///< the server that sends them on
    std::string room = {};       ///< by name; empty: any
  };
  /// Where a player is sent.
  struct Place {
    const Presence* p_server = nullptr;  ///< null: there is none
    std::string room = {};               ///< of that server; empty: it has said nothing of rooms
    explicit operator bool() const { return p_server != nullptr; }
  };
  /// A server that lets the player in: it is open, without a password, known by address and key, on a port
  /// that no system service has, and has a free place. The fullest below three quarters, for players look for
  /// company, else the one with most places. Of a server with rooms, a room of that game or name which has a
  /// free place, chosen in the same way; without such a wish the first one that has. The place is taken from
  /// then on, until the server has counted the player.
  Place choose(const Wish& wish);

  /// The same for the players of a server that is about to be full: the one with most places, and none is
  /// taken.
  Place roomiest(const Wish& wish) const;
  /// Is there a server for such players, be it full or closed?
  bool plays(const Wish& wish) const;
  /// Those of which three quarters are taken, or which let no players in.
  std::vector<Presence> crowded() const;

  std::vector<Presence> servers() const;
  std::size_t size() const { return m_servers.size(); }
  const FleetCounters& counters() const { return m_counters; }

 private:
  /// Players: since the server was heard, and in the intervals before, for they may still be on their way.
  using Sent = std::array<std::uint32_t, 3>;
  /// Of a server, or of a room.
  struct Load {
    std::uint32_t taken = 0;
    std::uint32_t places = 0;
    std::uint32_t free() const { return places - std::min(taken, places); }
    bool isCalm() const { return taken < places / 4 * 3; }
    /// For a player who looks for company.
    bool isBetterThan(const Load& other) const;
  };
  struct Entry {
    Presence presence;
    Time heard{};
    Sent sent{};
    std::map<std::string, Sent> sent_to;  ///< by room
    Load load() const;
    Load load(const PresenceRoom& room) const;
  };
  static bool isOfKind(const Entry& entry, const Wish& wish);
  /// The room that is wished for; null: none has a free place.
  static const PresenceRoom* findRoom(const Entry& entry, const Wish& wish);
  /// Of what the player is sent to; nothing: it has no place for them.
  static std::optional<Load> loadFor(const Entry& entry, const Wish& wish);
  static Place placeIn(const Entry& entry, const Wish& wish);

  std::chrono::milliseconds m_life;
  std::map<std::string, Entry> m_servers;
  FleetCounters m_counters;
};

/// The least port to which a player is sent: below are services of the system.
inline constexpr std::uint16_t kLeastFleetPort = 1024;

/// Keeps the list of a fleet's servers by what the bus brings. Not thread-safe. Time is passed in.
class FleetWatch {
 public:
  using Time = FleetList::Time;

  /// While the bus is gone the list stays as it was, for so long: the servers play on, and players still find
  /// them.
  static constexpr std::chrono::minutes kBlind{10};
  /// Lines about servers that come and go: names may come from a server that only pretends.
  static constexpr BucketRate kNewsRate{5, 100};

  /// `bus` listens to presence. `log`: a line for people. `interval`: as FleetList's.
  FleetWatch(std::unique_ptr<Bus> bus, std::function<void(const std::string& line)> log, Time now,
             std::chrono::milliseconds interval = Presence::kInterval);

  /// Some times a second.
  void update(Time now);

  FleetList& servers() { return m_servers; }
  const FleetList& servers() const { return m_servers; }
  Bus& bus() { return *m_bus; }

 private:
  void logNews(const std::string& line, Time now);

  std::unique_ptr<Bus> m_bus;
  std::function<void(const std::string& line)> m_log;
  FleetList m_servers;
  Time m_connected_at;
  TokenBucket m_news;
  std::uint64_t m_news_left_out = 0;
};

}  // namespace naiad
