// What one attack does to a server. It runs in a thread and an event loop of its own, beside honest players.
#pragma once

#include <asio/io_context.hpp>
#include <chrono>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "ServerProcess.h"

namespace bench::attack {

using Time = std::chrono::steady_clock::time_point;

/// The server under attack, and the loop to attack it from.
struct Target {
  asio::io_context& context;
  ServerProcess& server;
  std::chrono::seconds duration;
};

/// What an attack found out beside what is measured of all.
struct Findings {
  std::vector<std::pair<std::string, long long>> figures;  ///< keys and values, in the order of the line
  std::vector<std::string> faults;                         ///< keys of the figures that should be others
};

class Attack {
 public:
  virtual ~Attack() = default;

  /// How the server is started, beside what is the same for all.
  virtual ServerSetup setup() const { return {}; }
  /// In the attack's thread, from here to end().
  virtual void begin(const Target& target) = 0;
  /// About a hundred times a second.
  virtual void update(Time /*now*/) {}
  /// Let go of everything that belongs to the event loop.
  virtual void end() {}
  /// The server has been stopped.
  virtual void addFindings(Findings& /*findings*/) {}
};

}  // namespace bench::attack
