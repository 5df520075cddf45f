// Sends players the list of players at intervals: less often, and not the whole list, if there are many.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "shared/values/Color.h"

namespace naiad {

namespace wire {
class ServerMessage;
}

/// A player's entry in the list.
struct ListedPlayer {
  std::uint32_t id = 0;
  std::string name;  ///< UTF-8, sanitized by the server
  df::Color color = df::COLOR_DEFAULT;
  int score = 0;
};

/// With at most kMaxPlayers players, each gets the full list every kInterval ticks if it has changed. With
/// more, each gets the highest scores and their own entry every kCrowdInterval ticks: the list stays a
/// screenful, and the cost of all lists grows with the number of players, not with its square. A list that
/// does not fit in a frame lacks its last entries. Not thread-safe.
class PlayerListBroadcaster {
 public:
  static constexpr std::uint32_t kInterval = 15;        ///< ticks
  static constexpr std::uint32_t kCrowdInterval = 150;  ///< ticks, with more than kMaxPlayers players
  static constexpr std::size_t kCrowdEntries = 32;      ///< number of highest scores listed for a crowd

  /// Returns a player's round trip in milliseconds, or 0 if it is not known.
  using RoundTrip = std::function<std::uint32_t(std::uint32_t player)>;
  using Send = std::function<void(std::uint32_t player, const wire::ServerMessage& message)>;

  PlayerListBroadcaster();
  ~PlayerListBroadcaster();

  /// Calls `send` for each player that is due to get a list. Call it at the end of a tick.
  void tick(std::uint32_t tick, const std::vector<ListedPlayer>& players, const RoundTrip& round_trip,
            const Send& send);
  /// Sends the next list even if nothing has changed, because a client may have missed the last one.
  void repeat() { m_sent.clear(); }

 private:
  void sendToAll(const std::vector<ListedPlayer>& players, const RoundTrip& round_trip, const Send& send);
  void sendToSome(std::uint32_t tick, const std::vector<ListedPlayer>& players, const RoundTrip& round_trip,
                  const Send& send);
  void findBest(const std::vector<ListedPlayer>& players, const RoundTrip& round_trip);

  std::string m_sent;                           ///< the last list for all, serialised
  std::unique_ptr<wire::ServerMessage> m_best;  ///< highest scores, with more than kMaxPlayers players
};

}  // namespace naiad
