// A person at a terminal who plays a game: their keys go through the client's own decoder and HeldKeys into
// the world, one world tick after another, in virtual time.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "TypedKeyboard.h"
#include "World.h"
#include "client/terminal/HeldKeys.h"
#include "client/terminal/InputDecoder.h"

namespace naiad {

/// How keys are held in a terminal.
struct KeyMethod {
  std::string name;
  HoldRule rule;
  bool kitty = false;      ///< the terminal reports releases: what all others are compared with
  bool tap_to_go = false;  ///< the game offers: a tap of a direction goes on until another direction or X
};

class Typist {
 public:
  using Time = TypedKeyboard::Time;
  using Milliseconds = TypedKeyboard::Milliseconds;
  /// Of the world; not a whole number of the keyboard's intervals.
  static constexpr Milliseconds kTick{33};

  Typist(df::World& world, std::uint32_t player, const KeyMethod& method, TypedKeyboard::Options keyboard);

  /// Fingers: from now on these keys and no others are down.
  void hold(const std::set<df::Keyboard::Key>& keys);
  /// Let a tick go by: a millisecond after another, then the world's.
  void tick();
  /// So many milliseconds since the beginning.
  long elapsed() const { return static_cast<long>((m_now - Time{}) / Milliseconds(1)) - kBegin; }
  bool tapsToGo() const { return m_method.tap_to_go; }
  const std::set<df::Keyboard::Key>& fingers() const { return m_keyboard.down(); }

 private:
  static constexpr long kBegin = 3'600'000;

  void type(const std::string& bytes);
  void take(const std::vector<TerminalEvent>& events);
  void send(const std::vector<KeyAction>& actions);
  /// Tap-to-go: returns true if the key is a direction or X, which are handled here.
  bool takeGo(const KeyEvent& event);

  df::World& m_world;
  std::uint32_t m_player;
  KeyMethod m_method;
  TypedKeyboard m_keyboard;
  InputDecoder m_decoder;
  HeldKeys m_held;
  Time m_now = Time{} + Milliseconds(kBegin);
  std::optional<df::Keyboard::Key> m_going;
};

}  // namespace naiad
