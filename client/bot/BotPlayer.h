// Plays a script, or random input, tick by tick.
#pragma once

#include <cstdint>
#include <random>
#include <string>
#include <variant>
#include <vector>

#include "client/bot/BotScript.h"
#include "client/terminal/HeldKeys.h"

namespace naiad {

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

  /// What to send in this tick.
  std::vector<BotAction> tick();
  /// Nothing more will come.
  bool isDone() const { return m_at >= m_script.steps().size() && m_down == df::Keyboard::UNDEFINED_KEY; }

 private:
  void skipLoops();

  BotScript m_script;
  std::size_t m_at = 0;
  std::vector<int> m_rounds;  ///< rounds left of the open loops
  int m_left = 0;             ///< ticks left of the current step
  df::Keyboard::Key m_down = df::Keyboard::UNDEFINED_KEY;
};

/// Presses, holds and clicks at random, the same for the same seed everywhere.
class RandomPlayer {
 public:
  RandomPlayer(std::uint64_t seed, int view_width, int view_height);
  std::vector<BotAction> tick();

 private:
  int below(int limit);

  std::mt19937_64 m_random;
  int m_width;
  int m_height;
  int m_left = 0;
  df::Keyboard::Key m_down = df::Keyboard::UNDEFINED_KEY;
};

}  // namespace naiad
