// How a player notices the game's sounds: a short note, the terminal's bell, or nothing. Both are limited in
// rate, so that no game can ring without end or make the note flicker.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "client/session/ServerMessages.h"

namespace naiad {

enum class SoundMode : std::uint8_t {
  kNote,  ///< its name in the status line, for a moment
  kBell,  ///< the note, and the bell for sounds (not music) of this player or of no player
  kOff,
};

/// The mode called "note", "bell" or "off"; nothing for anything else.
std::optional<SoundMode> soundModeFrom(std::string_view name);

class SoundNotes {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// A note is shown for this long, and for at least kMin before another replaces it.
  static constexpr std::chrono::milliseconds kShown{1500};
  static constexpr std::chrono::milliseconds kMin{300};
  /// The bell rings at most once in this time.
  static constexpr std::chrono::milliseconds kBellEvery{1000};

  explicit SoundNotes(SoundMode mode) : m_mode(mode) {}

  /// The game played a sound; `self`: this player's id.
  void addSound(const SoundLine& sound, std::uint32_t self, Time now);
  /// The note to show: "sound: fire", "music: theme"; empty: none.
  std::string shownNote(Time now) const;
  /// Is the bell to ring now? True once.
  bool takeBell() { return std::exchange(m_rings, false); }

 private:
  void show(const SoundLine& sound, bool others, Time now);

  SoundMode m_mode;
  std::string m_note;
  bool m_of_others = false;  ///< of another player's action
  std::optional<Time> m_noted_at;
  std::optional<Time> m_rang_at;
  bool m_rings = false;
};

}  // namespace naiad
