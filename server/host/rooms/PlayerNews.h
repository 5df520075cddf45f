// Sends players the list of players: periodically, with a limit for large crowds.
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

/// What the list says of a player.
struct ListedPlayer {
  std::uint32_t id = 0;
  std::string name;  ///< UTF-8, as the server has cleaned it
  df::Color color = df::COLOR_DEFAULT;
  int score = 0;
};

/// Up to kMaxPlayers, every player gets the list of all, every half second if it has changed. In a larger
/// crowd each gets, every five seconds, those with the highest scores and their own entry: the list stays a
/// screenful, and what all lists cost grows with the crowd, not with its square. A list that does not fit in
/// a frame lacks its last entries. Not thread-safe.
class PlayerNews {
 public:
  static constexpr std::uint32_t kEvery = 15;        ///< ticks
  static constexpr std::uint32_t kCrowdEvery = 150;  ///< ticks
  static constexpr std::size_t kCrowdEntries = 32;

  /// Round trip of a player in milliseconds; 0: not known.
  using RoundTrip = std::function<std::uint32_t(std::uint32_t player)>;
  using Send = std::function<void(std::uint32_t player, const wire::ServerMessage& message)>;

  PlayerNews();
  ~PlayerNews();

  /// The end of a tick: call `send` for each player that is to get a list now.
  void tick(std::uint32_t tick, const std::vector<ListedPlayer>& players, const RoundTrip& round_trip,
            const Send& send);
  /// A client may have missed the last list: send the next one even if nothing has changed.
  void repeat() { m_sent.clear(); }

 private:
  void sendToAll(const std::vector<ListedPlayer>& players, const RoundTrip& round_trip, const Send& send);
  void sendToSome(std::uint32_t tick, const std::vector<ListedPlayer>& players, const RoundTrip& round_trip,
                  const Send& send);
  void findBest(const std::vector<ListedPlayer>& players, const RoundTrip& round_trip);

  std::string m_sent;                           ///< the last list for all, serialised
  std::unique_ptr<wire::ServerMessage> m_best;  ///< of a crowd
};

}  // namespace naiad
