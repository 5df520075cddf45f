// Stands in for the few classes of the graphics library SFML that show in the published engine's interface
// (DM.getWindow(), Sound::getSound(), Music::getMusic()): they take the usual calls and do nothing. A game
// that includes SFML's own headers is not one for a terminal; where those are installed, they are left alone.
#pragma once

#if __has_include(<SFML/Graphics/RenderWindow.hpp>)

#include <SFML/Audio/Music.hpp>
#include <SFML/Audio/Sound.hpp>
#include <SFML/Graphics/RenderWindow.hpp>

#else

namespace sf {

class SoundSource {
 public:
  enum Status { Stopped, Paused, Playing };
  void play() {}
  void pause() {}
  void stop() {}
  void setVolume(float volume) { m_volume = volume; }
  float getVolume() const { return m_volume; }
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

class Sound : public SoundSource {};
class Music : public SoundSource {};

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
  bool isOpen() const { return true; }
  bool hasFocus() const { return true; }
  void requestFocus() {}
  void display() {}
  void close() {}
};

}  // namespace sf

#endif
