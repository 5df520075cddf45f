// An attack on a server. It runs in its own thread and event loop while honest players play. docs/bench.md
// describes the attacks.
#pragma once

#include <asio/io_context.hpp>
#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "ServerProcess.h"

namespace bench::attack {

using Time = std::chrono::steady_clock::time_point;

/// The server under attack, and the event loop for the attack.
struct Target {
  asio::io_context& context;
  ServerProcess& server;
  std::chrono::seconds duration;
};

/// A figure as printed, and whether its value is a failure.
struct Figure {
  std::string key;
  double value = 0;
  bool is_fault = false;
};
using Figures = std::vector<Figure>;

class Attack {
 public:
  virtual ~Attack() = default;

  /// Returns the settings of the server that this attack needs, in addition to the common ones.
  virtual ServerSetup setup() const { return {}; }
  /// Called before the attacked server starts, with the folder of its identity and state.
  virtual void prepare(const std::string& /*folder*/) {}
  /// Returns for how long the attack runs before newcomers come and the players are measured.
  virtual std::chrono::seconds leadTime() const { return std::chrono::seconds(0); }
  /// Starts the attack. Called in the attack's thread, like update() and end().
  virtual void begin(const Target& target) = 0;
  /// Called about a hundred times a second.
  virtual void update(Time /*now*/) {}
  /// Ends the attack: releases everything that belongs to the event loop.
  virtual void end() {}
  /// Adds results that only this attack has. Called after the server has been stopped.
  virtual void addFigures(Figures& /*figures*/) {}
};

using AttackPtr = std::unique_ptr<Attack>;

inline constexpr const char* kHeldName = "held";  ///< name of the players of held_places
inline constexpr int kHeldAllowed = 2;            ///< slots allowed per address

}  // namespace bench::attack
