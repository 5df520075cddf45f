// What one attack does to a server. It runs in a thread and an event loop of its own, beside honest players.
// docs/bench.md describes the attacks.
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

using AttackPtr = std::unique_ptr<Attack>;

/// silent4, silent6: 64 connections from each of these addresses to the address of the server. They never say
/// a word, and one that is dropped reconnects.
AttackPtr makeSilentCrowd(const std::vector<std::string>& sources, const std::string& server);
/// chat_resume: one player resumes on another stream again and again, and says all it may on each.
AttackPtr makeChatResume();
/// chat_detached: players who say as much as they may, all the time.
AttackPtr makeChatters(int count);
/// held_places: one address joins and is killed, again and again, so that detached sessions hold places.
AttackPtr makeHeldPlaces();
inline constexpr const char* kHeldName = "held";  ///< of its players
inline constexpr int kHeldAllowed = 2;            ///< places for one address
/// log_stall, log_gone: what reads the server's log stands still, or ends; players give it something to say.
enum class LogFault { kStalls, kEnds };
AttackPtr makeLogReader(LogFault fault);
/// password80: 80 addresses guess, so that the queue of passwords to be compared is never empty.
AttackPtr makePasswordCrowd();
/// fork300: a game in a process of its own forks 300 children. Which of them outlive their world? This
/// process then inherits those whose parents end, so that none is lost sight of.
AttackPtr makeForkingWorld();

}  // namespace bench::attack
