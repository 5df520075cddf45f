// A keyboard at a terminal in virtual time. Turns pressed and released keys into the terminal's bytes, with
// the keyboard's repeats.
#pragma once

#include <chrono>
#include <set>
#include <string>

#include "shared/values/Keyboard.h"

namespace naiad {

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

}  // namespace naiad
