// Checks that a game is repeatable: a second world gets the turns of the first a little later, and their
// answers are compared. Covers the beginning of a round, where games read clocks and seed random numbers.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <string>

#include "host/world/WorldPort.h"

namespace naiad {

/// Returns the first difference between two views in words: in the changed Objects, their positions or
/// velocities, in scores, or in drawn characters. Empty if all of these are equal.
std::string describeDifference(const df::WorldView& first, const df::WorldView& again);

class DeterminismCheck {
 public:
  /// Number of ticks that are compared, and of ticks before the second world starts: two seconds of a usual
  /// game, so that the clocks of the worlds differ.
  static constexpr std::uint32_t kTicks = 900;
  static constexpr std::uint32_t kDelay = 60;
  /// Maximum number of turns for the second world per tick of the host: enough to catch up, in little time.
  static constexpr int kTurnsPerTick = 3;

  using NewWorld = std::function<std::unique_ptr<WorldPort>()>;
  /// `new_world` starts a world with the options of the first; if it throws std::system_error, nothing is
  /// compared. `on_difference` is called at most once, with a sentence.
  DeterminismCheck(NewWorld new_world, std::function<void(const std::string&)> on_difference);
  ~DeterminismCheck();

  /// Adds a turn that the first world has answered.
  void add(const SentTurn& turn, std::uint64_t answer_hash, const df::WorldView& view);
  /// Sends turns to the second world, once in each tick of the host. Returns false when the check is over.
  bool update();

 private:
  struct Tick {
    SentTurn sent;
    std::uint64_t answer_hash = 0;
    df::WorldView view;
  };
  void start();
  void sendNext();
  void compare();

  NewWorld m_new_world;
  std::function<void(const std::string&)> m_on_difference;
  std::unique_ptr<WorldPort> m_world;
  std::deque<Tick> m_waiting;
  std::uint32_t m_added = 0;
  std::uint32_t m_compared = 0;
  int m_allowed = 0;  ///< turns that may still be sent in this tick of the host
  bool m_over = false;
};

}  // namespace naiad
