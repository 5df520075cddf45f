// A sound or a piece of music of a game. The engine makes no noise: it records in the tick's WorldView what
// was played. A host sends that to clients, which play it as their player has chosen. Repeating sounds are
// kept for players that join later. Without clients they have no effect.
#pragma once

#include <string>
#include <utility>

#include "Sfml.h"
#include "detail/WorldView.h"

namespace df {

class Sound {
 public:
  Sound() = default;
  virtual ~Sound() = default;

  /// Returns 0 if the file can be read, else logs a line and returns -1. Its contents are not checked.
  int loadSound(const std::string& filename);

  /// Label under which it was loaded.
  void setLabel(std::string new_label) { m_label = std::move(new_label); }
  const std::string& getLabel() const { return m_label; }

  /// Plays from the beginning, or from where it paused; repeats if `loop`.
  void play(bool loop = false) { recordSound(SoundPlayed::kPlay, loop); }
  /// Stops; the next play() starts from the beginning.
  void stop() { recordSound(SoundPlayed::kStop, false); }
  /// Pauses; the next play() continues here.
  void pause() { recordSound(SoundPlayed::kPause, false); }

  /// Makes it play nothing, because it stands in for one that is missing.
  void silence() { m_silent = true; }

  /// Stops it if it repeats, before it is unloaded.
  void endLoop();

  /// Returns a stand-in for the published engine's SFML object: calls on it do nothing.
  sf::Sound getSound() const { return {}; }

 protected:
  /// Makes a piece of music if `music`.
  explicit Sound(bool music) : m_music(music) {}

 private:
  void recordSound(SoundPlayed::What what, bool loop);

  std::string m_label;
  bool m_music = false;
  bool m_silent = false;
};

}  // namespace df
