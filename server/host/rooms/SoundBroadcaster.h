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

/// Each player gets all sounds within the limits per tick and over time. Above the limits, the most important
/// sounds are sent: lasting ones (music, loops, pauses and stops), then the player's own, then those of no
/// player, then other players'. A sound played several times in a tick is sent once. A new player gets the
/// sounds that are playing. Not thread-safe.
class SoundBroadcaster {
 public:
  static constexpr std::size_t kPerTick = 4;          ///< sounds for one player in a tick
  static constexpr std::uint32_t kBurst = 12;         ///< burst: sounds for one player without a pause
  static constexpr std::uint32_t kTicksPerSound = 3;  ///< after a burst, one more sound per this many ticks
  /// Maximum number of different sounds in a tick; further ones are dropped.
  static constexpr std::size_t kMaxDifferent = 64;

  /// Returns whether the message was sent. `lasts`: it must arrive; otherwise it must be sent now or dropped.
  using Send = std::function<bool(std::uint32_t player, const wire::ServerMessage& message, bool lasts)>;

  /// Calls `send` for each player that is due to get sounds. Call it at the end of a tick.
  void tick(const df::WorldView& view, const Send& send);
  /// Treats the player as new, because their client may have missed sounds.
  void repeat(std::uint32_t player);
  /// Stops all lasting sounds for a player about to move to another world.
  void stopFor(std::uint32_t player, const Send& send);
  /// Stops all lasting sounds of a world that has ended, for all players, and treats them as new.
  void changeWorld(const Send& send);

  /// Numbers of sounds sent and dropped (too many or too late). A sound counts once per player.
  std::uint64_t sent() const { return m_sent; }
  std::uint64_t dropped() const { return m_dropped; }

 private:
  struct Listener {
    std::uint32_t player = 0;
    std::uint32_t credit = 0;  ///< unit: ticks; a sound costs kTicksPerSound, a lasting one three times that
    std::uint32_t tick = 0;    ///< tick in which `credit` was updated
  };

  void gatherSounds(const df::WorldView& view);
  void updateLasting(const df::SoundPlayed& sound);
  Listener addListener(std::uint32_t player, const df::WorldView& view, const Send& send);
  void sendSounds(Listener& listener, bool is_new, std::uint32_t tick, const Send& send);
  wire::ServerMessage stops() const;
  void sendMessage(std::uint32_t player, const wire::ServerMessage& message, bool lasts, const Send& send);

  std::vector<Listener> m_listeners;          ///< sorted by player id
  std::vector<Listener> m_listeners_before;   ///< scratch
  std::vector<const df::SoundPlayed*> m_now;  ///< different sounds of this tick
  std::vector<bool> m_chosen;                 ///< scratch, parallel to m_now
  std::size_t m_overflowed = 0;               ///< sounds lost in this tick: too many for the view or m_now
  std::uint64_t m_sent = 0;
  std::uint64_t m_dropped = 0;
  std::vector<df::SoundPlayed> m_lasting;  ///< sounds that clients keep playing until they get a stop
};

}  // namespace naiad
