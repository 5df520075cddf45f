// Is a game repeatable? A second world gets the same turns a little later, and its answers are held against
// those of the first: for the beginning of a round, where games read clocks and seed themselves.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <string>

#include "host/world/WorldPort.h"

namespace naiad {

/// What of two views is other first, in words; empty if nothing is.
std::string describeDifference(const df::WorldView& first, const df::WorldView& again);

class RepeatCheck {
 public:
  /// Ticks that are compared, and ticks after which the second world starts: two seconds, so that clocks
  /// differ.
  static constexpr std::uint32_t kTicks = 900;
  static constexpr std::uint32_t kDelay = 60;
  /// Turns that the second world gets in a tick of the host, at most: it catches up, and takes little time.
  static constexpr int kTurnsPerTick = 3;

  using NewWorld = std::function<std::unique_ptr<WorldPort>()>;
  /// `new_world` starts one from the same order; it may throw std::system_error, and nothing is compared
  /// then. `on_difference`: gets a sentence, once.
  RepeatCheck(NewWorld new_world, std::function<void(const std::string&)> on_difference);
  ~RepeatCheck();

  /// The first world has answered this turn.
  void add(const SentTurn& turn, std::uint64_t answer_hash, const df::WorldView& view);
  /// Once in each tick of the host. False: all has been compared.
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
  int m_allowed = 0;  ///< turns in this tick of the host
  bool m_over = false;
};

}  // namespace naiad
