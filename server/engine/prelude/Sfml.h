// Stands in for the graphics library SFML, which the published engine's headers include and some games use
// directly: DM.getWindow(), Sound::getSound(), Music::getMusic(), drawing on the window, asking for keys and
// buttons. Its classes and functions accept the usual calls and do nothing; no key is ever down. The folder
// SFML next to this file has the SFML headers that games include themselves.
#pragma once

#include <string>

#include "detail/SfmlDrawing.h"
#include "detail/SfmlInput.h"
#include "detail/SfmlValues.h"

namespace sf {

class SoundSource {
 public:
  enum Status { Stopped, Paused, Playing };
  void play() {}
  void pause() {}
  void stop() {}
  void setVolume(float volume) { m_volume = volume; }
  float getVolume() const { return m_volume; }
  void setPlayingOffset(Time /*offset*/) {}
  Time getPlayingOffset() const { return {}; }
  void setPitch(float pitch) { m_pitch = pitch; }
  float getPitch() const { return m_pitch; }
  void setLoop(bool loop) { m_loop = loop; }
  bool getLoop() const { return m_loop; }
  Status getStatus() const { return Stopped; }

 private:
  float m_volume = 100;
  float m_pitch = 1;
  bool m_loop = false;
};

class SoundBuffer {
 public:
  bool loadFromFile(const std::string& /*file*/) { return true; }
};

class Sound : public SoundSource {
 public:
  Sound() = default;
  explicit Sound(const SoundBuffer& /*buffer*/) {}
  void setBuffer(const SoundBuffer& /*buffer*/) {}
};

class Music : public SoundSource {
 public:
  bool openFromFile(const std::string& /*file*/) { return true; }
};

class RenderWindow {
 public:
  template <class... T>
  void setTitle(const T&... /*title*/) {}
  template <class... T>
  void setIcon(const T&... /*icon*/) {}
  template <class... T>
  void draw(const T&... /*what*/) {}
  template <class... T>
  void clear(const T&... /*color*/) {}
  void setMouseCursorVisible(bool /*visible*/) {}
  void setKeyRepeatEnabled(bool /*enabled*/) {}
  void setVerticalSyncEnabled(bool /*enabled*/) {}
  void setFramerateLimit(unsigned /*limit*/) {}
  void setVisible(bool /*visible*/) {}
  template <class... T>
  bool pollEvent(const T&... /*event*/) {
    return false;
  }
  template <class... T>
  void setView(const T&... /*view*/) {}
  template <class... T>
  void setSize(const T&... /*size*/) {}
  template <class... T>
  void setPosition(const T&... /*position*/) {}
  Vector2u getSize() const { return {1024, 768}; }
  Vector2i getPosition() const { return {}; }
  bool isOpen() const { return true; }
  bool hasFocus() const { return true; }
  void requestFocus() {}
  void display() {}
  void close() {}
};

}  // namespace sf
