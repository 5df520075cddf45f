// Simulates a person at a terminal, in virtual time. The keys pass through the client's own decoder and
// KeyHoldTracker into the world, tick by tick.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "TypedKeyboard.h"
#include "World.h"
#include "client/terminal/InputDecoder.h"
#include "client/terminal/KeyHoldTracker.h"

namespace naiad {

/// A method of holding keys in a terminal.
struct KeyMethod {
  std::string name;
  HoldRule rule;
  bool kitty = false;      ///< the terminal reports releases; the reference for the other methods
  bool tap_to_go = false;  ///< the game's mode in which a tapped direction lasts until another direction or X
};

class Typist {
 public:
  using Time = TypedKeyboard::Time;
  using Milliseconds = TypedKeyboard::Milliseconds;
  /// Time of a world tick, not a multiple of the keyboard's interval.
  static constexpr Milliseconds kTick{33};

  Typist(df::World& world, std::uint32_t player, const KeyMethod& method, TypedKeyboard::Options keyboard);

  /// Sets the keys that are down from now on.
  void hold(const std::set<df::Keyboard::Key>& keys);
  /// Simulates a tick: each millisecond at the keyboard, then the world's tick.
  void tick();
  const std::set<df::Keyboard::Key>& fingers() const { return m_keyboard.down(); }

 private:
  static constexpr long kBegin = 3'600'000;

  void type(const std::string& bytes);
  void take(const std::vector<TerminalEvent>& events);
  void send(const std::vector<KeyAction>& actions);
  /// Handles a key in the mode KeyMethod::tap_to_go. Returns true if it is a direction or X.
  bool takeGo(const KeyEvent& event);

  df::World& m_world;
  std::uint32_t m_player;
  KeyMethod m_method;
  TypedKeyboard m_keyboard;
  InputDecoder m_decoder;
  KeyHoldTracker m_held;
  Time m_now = Time{} + Milliseconds(kBegin);
  std::optional<df::Keyboard::Key> m_going;
};

}  // namespace naiad
