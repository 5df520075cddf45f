// An attack on a server. It runs in its own thread and event loop while honest players play. docs/bench.md
// describes the attacks.
#pragma once

#include <asio/io_context.hpp>
#include <chrono>
#include <memory>
#include <string>
#include <utility>
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

/// Results of an attack, apart from the common measurements.
struct Findings {
  std::vector<std::pair<std::string, long long>> figures;  ///< keys and values, in the order of the line
  std::vector<std::string> faults;                         ///< keys of the figures with bad values
};

class Attack {
 public:
  virtual ~Attack() = default;

  /// Returns how the server is started, apart from the common options.
  virtual ServerSetup setup() const { return {}; }
  /// Starts the attack. Called in the attack's thread, like update() and end().
  virtual void begin(const Target& target) = 0;
  /// Called about a hundred times a second.
  virtual void update(Time /*now*/) {}
  /// Releases everything that belongs to the event loop.
  virtual void end() {}
  /// Adds results. Called after the server has been stopped.
  virtual void addFindings(Findings& /*findings*/) {}
};

using AttackPtr = std::unique_ptr<Attack>;

/// silent4, silent6: 64 connections from each of these addresses to the server's address. They never send
/// anything, and reconnect after a disconnect.
AttackPtr makeSilentCrowd(const std::vector<std::string>& sources, const std::string& server);
/// chat_resume: a player resumes on another stream repeatedly and sends as much chat as allowed on each.
AttackPtr makeChatResume();
/// chat_detached: players that constantly send as much chat as possible.
AttackPtr makeChatters(int count);
/// held_places: an address joins and is killed repeatedly, so that detached sessions hold slots.
AttackPtr makeHeldPlaces();
inline constexpr const char* kHeldName = "held";  ///< name of its players
inline constexpr int kHeldAllowed = 2;            ///< slots allowed per address
/// log_stall, log_gone: the reader of the server's log stalls or exits, while players cause log lines.
enum class LogFault { kStalls, kEnds };
AttackPtr makeLogReader(LogFault fault);
/// password80: 80 addresses guess, so that the queue of password checks is never empty.
AttackPtr makePasswordCrowd();
/// fork300: a game in its own process forks 300 children. Counts those that outlive their world. This process
/// adopts children whose parents end, so that none is missed.
AttackPtr makeForkingWorld();

}  // namespace bench::attack
