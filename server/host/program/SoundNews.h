// What the game sounds, told to all who play: bounded, however much that is.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "engine/world/WorldView.h"
#include "naiad.pb.h"

namespace naiad {

/// Each hears of all sounds, but of what is too much, in a tick or in the long run, only what matters most:
/// what lasts (music, what loops, what pauses or stops), then what he did himself, then what nobody in
/// particular did. The same several times in a tick is once. Who is new hears of what goes on by then.
/// Not thread-safe.
class SoundNews {
 public:
  static constexpr std::size_t kPerTick = 4;        ///< to one player
  static constexpr std::uint32_t kAtOnce = 12;      ///< to one player …
  static constexpr std::uint32_t kTicksForOne = 3;  ///< … and then one more for so many ticks
  /// Different sounds of a tick that are looked at.
  static constexpr std::size_t kMaxDifferent = 64;

  /// Returns whether it was sent. `lasts`: it must arrive; else it is worth something at once or not at all.
  using Tell = std::function<bool(std::uint32_t player, const wire::ServerMessage& message, bool lasts)>;

  /// The end of a tick: call `tell` for everybody who is to hear something now.
  void tick(const df::WorldView& view, const Tell& tell);
  /// The player may have missed what was told: he is as one who is new.
  void repeat(std::uint32_t player);
  /// The world has ended and another one begins: all are told that what still lasts of the old one has
  /// stopped, and are as those who are new.
  void changeWorld(const Tell& tell);

  /// Sounds told, and not told since they were too many or came too late, each counted for each player.
  std::uint64_t told() const { return m_told; }
  std::uint64_t dropped() const { return m_dropped; }

 private:
  struct Listener {
    std::uint32_t player = 0;
    std::uint32_t credit = 0;  ///< in ticks: a sound costs kTicksForOne
    std::uint32_t tick = 0;    ///< when that was so
  };

  void gather(const df::WorldView& view);
  void noteLasting(const df::SoundPlayed& sound);
  Listener welcome(std::uint32_t player, const df::WorldView& view, const Tell& tell);
  void tellSounds(Listener& listener, bool is_new, std::uint32_t tick, const Tell& tell);
  void send(std::uint32_t player, const wire::ServerMessage& message, bool lasts, const Tell& tell);

  std::vector<Listener> m_listeners;          ///< by player
  std::vector<Listener> m_listeners_before;   ///< scratch
  std::vector<const df::SoundPlayed*> m_now;  ///< of this tick, each once
  std::vector<bool> m_chosen;                 ///< of these, scratch
  std::size_t m_left_out = 0;                 ///< of this tick, beyond m_now
  std::uint64_t m_told = 0;
  std::uint64_t m_dropped = 0;
  std::vector<df::SoundPlayed> m_lasting;  ///< what clients may go on with until they hear that it stopped
};

}  // namespace naiad
