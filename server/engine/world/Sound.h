// A sound or a piece of music of a game. The engine makes no noise: it records in the tick's WorldView which
// sounds were played. A host sends this to clients, which play them if their player has chosen so. Repeating
// sounds are also played to players that join later. Without clients, sounds have no effect.
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

  /// Label under which the sound was loaded.
  void setLabel(std::string new_label) { m_label = std::move(new_label); }
  const std::string& getLabel() const { return m_label; }

  /// Plays the sound from the beginning, or from where it paused; repeats it if `loop`.
  void play(bool loop = false) { recordSound(SoundPlayed::kPlay, loop); }
  /// Stops the sound; the next play() starts from the beginning.
  void stop() { recordSound(SoundPlayed::kStop, false); }
  /// Pauses the sound; the next play() continues from there.
  void pause() { recordSound(SoundPlayed::kPause, false); }

  /// If `silent`, this sound plays nothing, because it stands in for a missing sound.
  void silence(bool silent = true) { m_silent = silent; }
  bool isSilent() const { return m_silent; }

  /// Stops the sound if it repeats. Call before it is unloaded.
  void endLoop();

  /// Returns a stand-in for the published engine's SFML object: calls on it do nothing.
  sf::Sound getSound() const { return {}; }

 protected:
  /// Makes a piece of music if `music`, else a sound.
  explicit Sound(bool music) : m_music(music) {}

 private:
  void recordSound(SoundPlayed::What what, bool loop);

  std::string m_label;
  bool m_music = false;
  bool m_silent = false;
};

}  // namespace df
