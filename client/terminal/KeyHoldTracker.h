// Converts a terminal's key presses to Dragonfly's three key actions: pressed, held down, released.
//
// Most terminals report only that a key typed a character; a held key repeats it after a pause of 0.25 to
// 0.7 s. So a release is guessed from silence, by a HoldRule. With the kitty protocol real releases arrive,
// and nothing is guessed. docs/terminals.md has the rules that were compared.
//
// The keyboard's repeat interval and pause are learned from all keys together. The caller passes the time.
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

/// Rule that guesses unreported releases. The default plays best in games; other values are for comparison.
struct HoldRule {
  /// Default of `companion`: long enough to keep running in a jump, too short to run far after both releases.
  static constexpr std::chrono::milliseconds kCompanion{300};

  /// Treatment of the first press of a direction key (arrows, WASD). A press of any other key is a tap.
  enum class First : std::uint8_t {
    kTap,      ///< released after the release delay; the first repeat is a new press
    kUsual,    ///< held a little longer than kUsualPause, unless another key releases it (see below)
    kLearned,  ///< like kUsual, with the pause learned in this terminal; a tap until one was learned
  };
  First first = First::kTap;
  /// Time for which a repeating key stays down after another key was pressed, because keyboards repeat only
  /// the key pressed last. Zero: a key that has repeated is released like any key that falls silent; one
  /// that is held by kUsual or kLearned is released at once.
  std::chrono::milliseconds companion{kCompanion};
  /// If true, a direction key is released when the opposite one is pressed.
  bool opposites = true;
};

class KeyHoldTracker {
 public:
  using Time = std::chrono::steady_clock::time_point;
  using Duration = std::chrono::steady_clock::duration;

  /// Minimum of releaseDelay().
  static constexpr std::chrono::milliseconds kMinRelease{80};
  /// Maximum of releaseDelay(), even if the repeats are slow.
  static constexpr std::chrono::milliseconds kMaxRelease{250};
  /// Pause of most keyboards before the first repeat.
  static constexpr std::chrono::milliseconds kUsualPause{500};
  /// Shortest and longest pause before the first repeat that is learned.
  static constexpr std::chrono::milliseconds kMinPause{150};
  static constexpr std::chrono::milliseconds kMaxPause{1000};
  /// Limit on keys that report KEY_DOWN in one tick; further keys still report presses and releases.
  static constexpr std::size_t kMaxHeld = 6;

  KeyHoldTracker() = default;
  explicit KeyHoldTracker(const HoldRule& rule) : m_rule(rule) {}

  /// `real`: the terminal reports releases (kitty), so nothing is guessed. Releases all keys if this changes.
  std::vector<KeyAction> setRealReleases(bool real);

  /// Converts a key event decoded at `now`. Events without a key yield only releases that are due.
  std::vector<KeyAction> handleKey(const KeyEvent& event, Time now);
  /// Returns the guessed releases that are due. Call at deadline().
  std::vector<KeyAction> expire(Time now);
  /// Returns when expire() will have something to do; Time::max() if never.
  Time deadline() const;
  /// Returns the KEY_DOWN actions of one tick. Call once per tick.
  std::vector<KeyAction> tick() const;
  /// Releases all keys, e.g. when a chat line opens or the program is suspended.
  std::vector<KeyAction> releaseAll();

  /// Returns the silence after which a repeating key counts as released: 1.5 times the interval at which it
  /// repeats, between kMinRelease and kMaxRelease.
  Duration releaseDelay() const;
  /// Returns the keyboard's pause before the first repeat; zero until one was seen.
  Duration pause() const { return m_pause; }

 private:
  struct Held {
    Time last;
    Time until;              ///< time of its release, unless it is typed again before
    bool repeating = false;  ///< reports KEY_DOWN
    bool bridging = false;   ///< kept down during the pause before the first repeat
    bool silenced = false;   ///< another key was pressed after its last repeat
  };
  std::vector<KeyAction> handleTyped(df::Keyboard::Key key, Time now);
  void pressFirst(df::Keyboard::Key key, Held& held, Time now);
  void handleRepeat(Held& held, Time now);
  void updateOtherHolds(df::Keyboard::Key key, Time now, std::vector<KeyAction>& out);
  void learnInterval(Duration gap);
  void learnPause(df::Keyboard::Key key, Time now);
  Duration bridge(df::Keyboard::Key key) const;

  HoldRule m_rule;
  bool m_real = false;
  Duration m_interval = std::chrono::milliseconds(35);
  Duration m_pause{};
  std::map<df::Keyboard::Key, Held> m_held;
  /// Times of a key's last two presses or repeats.
  struct Past {
    Time first;  ///< time before `last`
    Time last;
  };
  std::map<df::Keyboard::Key, Past> m_past;
};

}  // namespace naiad
