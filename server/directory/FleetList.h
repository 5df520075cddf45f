// The servers that have said on the bus that they are there, and which of them a player is sent to.
//
// What they say may be wrong in any way: it is read strictly (Presence.h), counts only under the name that
// its subject has, and ends by itself.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "shared/fleet/Presence.h"

namespace naiad {

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
  };
  /// A server that lets the player in: it is open, without a password, known by address and key, on a port
  /// that no system service has, and has a free place. The fullest below three quarters, for players look for
  /// company, else the one with most places. The place is taken from then on, until the server has counted
  /// the player. Null: there is none.
  const Presence* choose(const Wish& wish);

  /// The same for the players of a server that is about to be full: the one with most places, and none is
  /// taken.
  const Presence* roomiest(const Wish& wish) const;
  /// Is there a server for such players, be it full or closed?
  bool plays(const Wish& wish) const;
  /// Those of which three quarters are taken, or which let no players in.
  std::vector<Presence> crowded() const;

  std::vector<Presence> servers() const;
  std::size_t size() const { return m_servers.size(); }
  const FleetCounters& counters() const { return m_counters; }

 private:
  struct Entry {
    Presence presence;
    Time heard{};
    /// Players: since it was heard, and in the intervals before, for they may still be on their way.
    std::array<std::uint32_t, 3> sent{};
    std::uint32_t taken() const { return presence.players + sent[0] + sent[1] + sent[2]; }
  };
  static bool isOfKind(const Entry& entry, const Wish& wish);
  static bool fits(const Entry& entry, const Wish& wish);
  static bool isCalm(const Entry& entry);
  static bool isBetter(const Entry& a, const Entry& b);

  std::chrono::milliseconds m_life;
  std::map<std::string, Entry> m_servers;
  FleetCounters m_counters;
};

/// The least port to which a player is sent: below are services of the system.
inline constexpr std::uint16_t kLeastFleetPort = 1024;

}  // namespace naiad
