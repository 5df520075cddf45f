// Scripts for dfbot: a small language for key presses, clicks and chat.
//
//   press KEY              press, and release a tick later
//   hold KEY TICKS         press, keep down for TICKS ticks, release
//   wait TICKS
//   click X Y [BUTTON]     at a cell of the view; BUTTON: left (default), right, middle
//   move X Y               move the mouse to a cell of the view
//   chat TEXT              say TEXT, which extends to the end of the statement
//   repeat N { … }         run the statements N times (1 to 1000000)
//   repeat                 restart the script, without end; only as the last statement
//
// Statements are separated by ';' or line ends; '#' begins a comment, except in TEXT. KEY is a name of
// df::Keyboard::Key (LEFTARROW, SPACE, F1, A, NUM1), in upper or lower case, or a digit. Every statement but
// repeat takes at least a tick, so a script cannot flood a server.
#pragma once

#include <cstdint>
#include <optional>
#include <random>
#include <string>
#include <variant>
#include <vector>

#include "client/terminal/KeyHoldTracker.h"
#include "shared/values/Keyboard.h"

namespace naiad {

struct BotStep {
  enum class Kind : unsigned char { kPress, kHold, kWait, kClick, kMove, kChat, kLoop, kEndLoop, kRestart };
  Kind kind = Kind::kWait;
  df::Keyboard::Key key = df::Keyboard::UNDEFINED_KEY;
  df::Mouse::Button button = df::Mouse::LEFT;
  int x = 0;
  int y = 0;
  int count = 1;           ///< number of ticks or of loop rounds
  std::size_t target = 0;  ///< kEndLoop: index of its kLoop step
  std::string text{};
};

/// Position of an error in a script, and its description. Line and column count from 1.
struct ScriptError {
  int line = 1;
  int column = 1;
  std::string message;
};

class BotScript {
 public:
  static std::variant<BotScript, ScriptError> parse(const std::string& text);

  const std::vector<BotStep>& steps() const { return m_steps; }

 private:
  friend class BotScriptParser;
  std::vector<BotStep> m_steps;
};

/// Returns the key with this name in scripts; nullopt for unknown names.
std::optional<df::Keyboard::Key> keyByName(const std::string& name);

struct BotClick {
  df::EventMouseAction action = df::CLICKED;
  df::Mouse::Button button = df::Mouse::LEFT;
  int x = 0;
  int y = 0;
};
struct BotChat {
  std::string text;
};
using BotAction = std::variant<KeyAction, BotClick, BotChat>;

/// Runs a script. Call tick() once per tick.
class ScriptPlayer {
 public:
  explicit ScriptPlayer(BotScript script) : m_script(std::move(script)) {}

  /// Advances the script by one tick. Returns the actions to send in this tick.
  std::vector<BotAction> tick();
  /// True if all steps have begun and no key is down; a last `wait` may still have ticks left.
  bool isDone() const { return m_at >= m_script.steps().size() && m_down == df::Keyboard::UNDEFINED_KEY; }

 private:
  void skipLoops();

  BotScript m_script;
  std::size_t m_at = 0;
  std::vector<int> m_rounds;  ///< remaining rounds of the open loops, innermost last
  int m_remaining = 0;        ///< remaining ticks of the current step
  df::Keyboard::Key m_down = df::Keyboard::UNDEFINED_KEY;
};

/// Presses and holds keys and clicks at random, equally on every platform for equal seeds and view sizes.
class RandomPlayer {
 public:
  RandomPlayer(std::uint64_t seed, int view_width, int view_height);
  /// Returns the actions to send in the next tick.
  std::vector<BotAction> tick();

 private:
  int below(int limit);

  std::mt19937_64 m_random;
  int m_width;
  int m_height;
  int m_remaining = 0;
  df::Keyboard::Key m_down = df::Keyboard::UNDEFINED_KEY;
};

}  // namespace naiad
