// A piece of music: as a Sound, but by default it repeats.
#pragma once

#include "Sound.h"

namespace df {

class Music : private Sound {
 public:
  Music() : Sound(true) {}
  Music(const Music&) = delete;
  Music& operator=(const Music&) = delete;

  /// Return 0 if there is such a file, else -1, with a line in the log. What is in it is not looked at.
  int loadMusic(const std::string& filename) { return loadSound(filename); }

  using Sound::endLoop;
  using Sound::getLabel;
  using Sound::pause;
  using Sound::setLabel;
  using Sound::silence;
  using Sound::stop;
  /// From its beginning, or from where it paused; again and again, unless `loop` is false.
  void play(bool loop = true) { Sound::play(loop); }

  /// What stands in for the published engine's member of a graphics library: it takes calls and does nothing.
  sf::Music* getMusic() { return &m_stub; }

 private:
  sf::Music m_stub;
};

}  // namespace df
