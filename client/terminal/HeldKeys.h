// From a terminal's key presses to the book's three actions: pressed, held down, released.
//
// Most terminals report only that a key typed a character; a held key types it again and again, after a
// pause of about half a second. So a release is guessed from silence:
//   - the first byte is KEY_PRESSED
//   - a second one before the release time has passed means the key is held: KEY_DOWN once per tick
//   - KEY_RELEASED comes 1.5 times the learned repeat interval (>= 80 ms) after the last byte
// During the pause before the keyboard repeats, the key therefore counts as released; the first repeat is
// a new press. With the kitty protocol real releases arrive, and nothing is guessed.
//
// The interval is the keyboard's, so it is learned from all keys together. Time is a parameter.
#pragma once

#include <chrono>
#include <cstddef>
#include <map>
#include <vector>

#include "client/terminal/InputDecoder.h"

namespace naiad {

/// A key's action, as the game receives it.
struct KeyAction {
  df::Keyboard::Key key = df::Keyboard::UNDEFINED_KEY;
  df::EventKeyboardAction action = df::UNDEFINED_KEYBOARD_ACTION;
  friend bool operator==(const KeyAction&, const KeyAction&) = default;
};

class HeldKeys {
 public:
  using Time = std::chrono::steady_clock::time_point;
  using Duration = std::chrono::steady_clock::duration;

  /// No release is guessed sooner than this after the last byte, …
  static constexpr std::chrono::milliseconds kMinRelease{80};
  /// … nor later than this, however slow the repeats.
  static constexpr std::chrono::milliseconds kMaxRelease{250};
  /// Keys that report KEY_DOWN in one tick; further ones are still pressed and released.
  static constexpr std::size_t kMaxHeld = 6;

  /// The terminal reports releases (kitty): stop guessing. Releases all keys when it changes.
  std::vector<KeyAction> setRealReleases(bool real);

  /// A key event as decoded at `now`. Events without a key give nothing.
  std::vector<KeyAction> takeKey(const KeyEvent& event, Time now);
  /// Releases that are due by now. Call at deadline().
  std::vector<KeyAction> expire(Time now);
  /// When expire() will have something to do; the far future if never.
  Time deadline() const;
  /// The KEY_DOWNs of one tick. Call once per tick.
  std::vector<KeyAction> tick() const;
  /// Release everything: a text line opens, the program is suspended.
  std::vector<KeyAction> releaseAll();

  /// Silence after which a key is taken as released.
  Duration releaseDelay() const;

 private:
  struct Held {
    Time last;
    bool repeating = false;
  };
  void learn(Duration gap);

  bool m_real = false;
  Duration m_interval = std::chrono::milliseconds(35);
  std::map<df::Keyboard::Key, Held> m_held;
};

}  // namespace naiad
