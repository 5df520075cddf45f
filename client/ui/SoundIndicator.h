// Shows the game's sounds as a short note, the terminal's bell, or not at all. Notes and bell are limited in
// rate, so that a game can neither ring without end nor make the note flicker.
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
  kNote,  ///< show the sound's name in the status line for a moment
  kBell,  ///< also ring the bell for sounds (not music) of this player or of no player
  kOff,
};

/// Returns the mode called "note", "bell" or "off"; nullopt for other names.
std::optional<SoundMode> soundModeFrom(std::string_view name);

class SoundIndicator {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// A note is shown for kShown. Within its first kMin, a note of another player's sound is replaced only by
  /// a sound of this player or of no player; other notes are not replaced.
  static constexpr std::chrono::milliseconds kShown{1500};
  static constexpr std::chrono::milliseconds kMin{300};
  /// Minimum interval between two rings of the bell.
  static constexpr std::chrono::milliseconds kMinBellInterval{1000};

  explicit SoundIndicator(SoundMode mode) : m_mode(mode) {}

  /// Call when the game has played or stopped a sound. `self`: this player's id.
  void addSound(const SoundLine& sound, std::uint32_t self, Time now);
  /// Returns the note to show, such as "sound: fire" or "music: theme"; may be empty.
  std::string shownNote(Time now) const;
  /// Returns true, once, if the bell should ring.
  bool popBell() { return std::exchange(m_rings, false); }

 private:
  void show(const SoundLine& sound, bool others, Time now);

  SoundMode m_mode;
  std::string m_note;
  bool m_of_others = false;  ///< m_note is of another player's sound
  std::optional<Time> m_noted_at;
  std::optional<Time> m_rang_at;
  bool m_rings = false;
};

}  // namespace naiad
