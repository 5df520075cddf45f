// Simulates a person at a terminal, in virtual time. The keys pass through the client's own decoder and
// KeyHoldTracker into the world, tick by tick.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "World.h"
#include "client/terminal/InputDecoder.h"
#include "client/terminal/KeyHoldTracker.h"
#include "shared/values/Keyboard.h"

namespace naiad {

/// A keyboard at a terminal in virtual time. Turns pressed and released keys into the terminal's bytes, with
/// the keyboard's repeats.
class TypedKeyboard {
 public:
  using Time = std::chrono::steady_clock::time_point;
  using Milliseconds = std::chrono::milliseconds;

  struct Options {
    Milliseconds pause{250};    ///< delay before the first repeat
    Milliseconds interval{33};  ///< time between repeats
    bool kitty = false;         ///< the terminal speaks the kitty protocol
  };

  explicit TypedKeyboard(const Options& options) : m_options(options) {}

  /// Presses a key at `now` and returns the terminal's bytes. Supports only the arrows, space and X.
  std::string press(df::Keyboard::Key key, Time now);
  std::string release(df::Keyboard::Key key);
  /// Returns the repeats due by `now`. Only the key pressed last repeats, while it is down.
  std::string repeat(Time now);
  const std::set<df::Keyboard::Key>& down() const { return m_down; }

 private:
  std::string bytes(df::Keyboard::Key key, char action) const;

  Options m_options;
  std::set<df::Keyboard::Key> m_down;
  df::Keyboard::Key m_repeats = df::Keyboard::UNDEFINED_KEY;
  Time m_due{};
};

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
