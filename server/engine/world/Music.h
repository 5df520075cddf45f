// A piece of music: like a Sound, but it repeats by default.
#pragma once

#include "Sound.h"

namespace df {

class Music : private Sound {
 public:
  Music() : Sound(true) {}
  Music(const Music&) = delete;
  Music& operator=(const Music&) = delete;

  /// Returns 0 if the file can be read, else logs a line and returns -1. Its contents are not checked.
  int loadMusic(const std::string& filename) { return loadSound(filename); }

  using Sound::endLoop;
  using Sound::getLabel;
  using Sound::isSilent;
  using Sound::pause;
  using Sound::setLabel;
  using Sound::silence;
  using Sound::stop;
  /// Plays from the beginning, or from where the music paused; repeats unless `loop` is false.
  void play(bool loop = true) { Sound::play(loop); }

  /// Returns a stand-in for the published engine's SFML object: calls on it do nothing.
  sf::Music* getMusic() { return &m_stub; }

 private:
  sf::Music m_stub;
};

}  // namespace df
