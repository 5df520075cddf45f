// Sends players the game's sounds, with a limit per player.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "engine/world/WorldView.h"

namespace naiad {

namespace wire {
class ServerMessage;
}

/// Each player gets all sounds, but of what is too much, in a tick or in the long run, only what matters
/// most: first what lasts (music, what loops, what pauses or stops), then the player's own sounds, then those
/// of no player. The same sound several times in a tick is sent once. A new player gets what is playing by
/// then. Not thread-safe.
class SoundNews {
 public:
  static constexpr std::size_t kPerTick = 4;        ///< to one player
  static constexpr std::uint32_t kAtOnce = 12;      ///< to one player …
  static constexpr std::uint32_t kTicksForOne = 3;  ///< … and then one more for so many ticks
  /// Different sounds of a tick that are considered.
  static constexpr std::size_t kMaxDifferent = 64;

  /// Returns whether it was sent. `lasts`: it must arrive; else it is worth something at once or not at all.
  using Send = std::function<bool(std::uint32_t player, const wire::ServerMessage& message, bool lasts)>;

  /// The end of a tick: call `send` for each player that is to get something now.
  void tick(const df::WorldView& view, const Send& send);
  /// The player's client may have missed what was sent: treat them as new.
  void repeat(std::uint32_t player);
  /// The player goes to another world: send them a stop for what still lasts.
  void stopFor(std::uint32_t player, const Send& send);
  /// The world has ended and another one begins: send all players a stop for what still lasts of the old one,
  /// and treat them as new.
  void changeWorld(const Send& send);

  /// Sounds sent, and not sent because they were too many or came too late, each counted for each player.
  std::uint64_t sent() const { return m_sent; }
  std::uint64_t dropped() const { return m_dropped; }

 private:
  struct Listener {
    std::uint32_t player = 0;
    std::uint32_t credit = 0;  ///< in ticks: a sound costs kTicksForOne
    std::uint32_t tick = 0;    ///< at whose end that was the credit
  };

  void gatherSounds(const df::WorldView& view);
  void noteLasting(const df::SoundPlayed& sound);
  Listener addListener(std::uint32_t player, const df::WorldView& view, const Send& send);
  void sendSounds(Listener& listener, bool is_new, std::uint32_t tick, const Send& send);
  wire::ServerMessage stops() const;
  void sendMessage(std::uint32_t player, const wire::ServerMessage& message, bool lasts, const Send& send);

  std::vector<Listener> m_listeners;          ///< by player
  std::vector<Listener> m_listeners_before;   ///< scratch
  std::vector<const df::SoundPlayed*> m_now;  ///< of this tick, each once
  std::vector<bool> m_chosen;                 ///< of these, scratch
  std::size_t m_left_out = 0;                 ///< of this tick, beyond m_now
  std::uint64_t m_sent = 0;
  std::uint64_t m_dropped = 0;
  std::vector<df::SoundPlayed> m_lasting;  ///< what clients go on playing until they get a stop
};

}  // namespace naiad
