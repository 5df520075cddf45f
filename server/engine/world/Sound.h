// A sound or a piece of music of a game. The engine makes no noise: that something was played is written into
// the tick's WorldView, from which a host sends it to clients, which play it as their player has chosen.
// Sounds that repeat are kept for players that join later. Without clients they have no effect.
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

  /// Return 0 if there is such a file, else -1, with a line in the log. What is in it is not looked at.
  int loadSound(const std::string& filename);

  /// The name under which it was loaded.
  void setLabel(std::string new_label) { m_label = std::move(new_label); }
  const std::string& getLabel() const { return m_label; }

  /// From its beginning, or from where it paused; again and again, if `loop`.
  void play(bool loop = false) { notePlayed(SoundPlayed::kPlay, loop); }
  /// The next play() is from its beginning.
  void stop() { notePlayed(SoundPlayed::kStop, false); }
  /// The next play() goes on here.
  void pause() { notePlayed(SoundPlayed::kPause, false); }

  /// From now on it plays nothing: it stands in for one that is missing.
  void silence() { m_silent = true; }

  /// Stop it if it goes on again and again: it is about to be unloaded.
  void endLoop();

  /// What stands in for the published engine's member of a graphics library: it takes calls and does nothing.
  sf::Sound getSound() const { return {}; }

 protected:
  /// For Music.
  explicit Sound(bool music) : m_music(music) {}

 private:
  void notePlayed(SoundPlayed::What what, bool loop);

  std::string m_label;
  bool m_music = false;
  bool m_silent = false;
};

}  // namespace df
