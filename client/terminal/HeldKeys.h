// From a terminal's key presses to the book's three actions: pressed, held down, released.
//
// Most terminals report only that a key typed a character; a held key types it again and again, after a
// pause of 0.25 to 0.7 s. So a release is guessed from silence, by a HoldRule. With the kitty protocol real
// releases arrive, and nothing is guessed. docs/terminals.md has the rules that were compared.
//
// The interval and the pause are the keyboard's, so they are learned from all keys together. Time is a
// parameter.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
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

/// What is guessed about keys whose releases the terminal does not report. The default is what plays best in
/// the games; the others are there to be compared with it.
struct HoldRule {
  /// Long enough to run on over a gap, too short to run far when both keys were released.
  static constexpr std::chrono::milliseconds kCompanion{300};

  /// What the first press of a key that gives a direction (arrows, WASD) counts for. Other keys are taps.
  enum class First : std::uint8_t {
    kTap,      ///< released after the release delay; the first repeat is a new press
    kUsual,    ///< held for kUsualPause, unless another key comes
    kLearned,  ///< held for the pause seen in this terminal, unless another key comes; a tap until one was
               ///< seen
  };
  First first = First::kTap;
  /// A key that repeated stays down so long after another key was pressed, which silences it: keyboards
  /// repeat only the key pressed last. Zero: it is released like any silent key.
  std::chrono::milliseconds companion{kCompanion};
  /// A direction ends when the opposite one is pressed.
  bool opposites = true;
};

class HeldKeys {
 public:
  using Time = std::chrono::steady_clock::time_point;
  using Duration = std::chrono::steady_clock::duration;

  /// No release is guessed sooner than this after the last byte, …
  static constexpr std::chrono::milliseconds kMinRelease{80};
  /// … nor later than this, however slow the repeats.
  static constexpr std::chrono::milliseconds kMaxRelease{250};
  /// The pause of most keyboards before the first repeat.
  static constexpr std::chrono::milliseconds kUsualPause{500};
  /// Pauses are between these.
  static constexpr std::chrono::milliseconds kMinPause{150};
  static constexpr std::chrono::milliseconds kMaxPause{1000};
  /// Keys that report KEY_DOWN in one tick; further ones are still pressed and released.
  static constexpr std::size_t kMaxHeld = 6;

  HeldKeys() = default;
  explicit HeldKeys(const HoldRule& rule) : m_rule(rule) {}

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

  /// Silence after which a key that repeats is taken as released.
  Duration releaseDelay() const;
  /// The keyboard's pause before the first repeat; zero until one was seen.
  Duration pause() const { return m_pause; }

 private:
  struct Held {
    Time last;
    Time until;              ///< released then, if nothing comes
    bool repeating = false;  ///< reports KEY_DOWN
    bool bridging = false;   ///< held over the pause
    bool silenced = false;   ///< another key was pressed since it repeated
  };
  std::vector<KeyAction> takeTyped(df::Keyboard::Key key, Time now);
  void pressFirst(df::Keyboard::Key key, Held& held, Time now);
  void takeRepeat(Held& held, Time now);
  void pressBeside(df::Keyboard::Key key, Time now, std::vector<KeyAction>& out);
  void learnInterval(Duration gap);
  void learnPause(df::Keyboard::Key key, Time now);
  Duration bridge(df::Keyboard::Key key) const;

  HoldRule m_rule;
  bool m_real = false;
  Duration m_interval = std::chrono::milliseconds(35);
  Duration m_pause{};
  std::map<df::Keyboard::Key, Held> m_held;
  /// What a key typed before.
  struct Past {
    Time first;  ///< when it typed the last time but one
    Time last;
  };
  std::map<df::Keyboard::Key, Past> m_past;
};

}  // namespace naiad
