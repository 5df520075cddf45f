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

/// Results that only this attack has, in addition to the common measurements.
struct Findings {
  std::vector<std::pair<std::string, long long>> figures;  ///< keys and values, as printed
  std::vector<std::string> faults;                         ///< keys of the figures whose values are a failure
};

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
  /// Adds results. Called after the server has been stopped.
  virtual void addFindings(Findings& /*findings*/) {}
};

using AttackPtr = std::unique_ptr<Attack>;

/// silent4, silent6: 64 connections from each of the addresses `sources` to the address `server`. They never
/// send anything, and reconnect when they are closed.
AttackPtr makeSilentCrowd(const std::vector<std::string>& sources, const std::string& server);
/// chat_resume: a player repeatedly resumes its session on another stream, and sends as much chat as allowed
/// on each.
AttackPtr makeChatResume();
/// chat_detached: `count` players that constantly send as much chat as possible.
AttackPtr makeChatters(std::size_t count);
/// held_places: clients of one address repeatedly join and are killed, so that their detached sessions hold
/// slots.
AttackPtr makeHeldPlaces();
inline constexpr const char* kHeldName = "held";  ///< name of the players of held_places
inline constexpr int kHeldAllowed = 2;            ///< slots allowed per address
/// log_stall, log_gone: the reader of the server's log stalls or exits, while players cause log lines.
enum class LogFault { kStalls, kEnds };
AttackPtr makeLogReader(LogFault fault);
/// password80: clients of 80 addresses guess passwords, so that the queue of password checks is never empty.
AttackPtr makePasswordCrowd();
/// fork300: a game in its own process forks 300 children. Counts the children that outlive their world. This
/// process adopts children whose parents end, so that all are counted.
AttackPtr makeForkingWorld();
/// restart8: the server was killed with eight players, and restarted after the time to reconnect.
AttackPtr makeLateRestart();
/// rounds5: before the server's start, its folder of rounds gets damaged, foreign and special files.
AttackPtr makeHostileRounds();
/// door3000: visitors of an ssh door have terminals of 3000 × 3000 cells and larger.
AttackPtr makeLargeTerminals();
/// idle64: one address takes all places and presses no key.
AttackPtr makeIdleCrowd();
/// password2000: 2,000 networks guess a password, each once a minute.
AttackPtr makeKnockingNetworks();
/// bus20k: a member of the bus sends 20,000 messages a second.
AttackPtr makeBusFlood();

/// hard_pile: a hostile server shows dfclient 48,000 moving HARD Objects in one place. Measures the time
/// until dfclient handles SIGTERM and Ctrl-C.
struct PileResult {
  double sigterm_ms = 0;  ///< time from the signal until dfclient ended; kPilePatience if it did not
  double ctrl_c_ms = 0;
  long long objects = 0;  ///< objects sent to dfclient
  bool ended = false;     ///< dfclient ended before the signal
};

inline constexpr std::chrono::milliseconds kPilePatience{10000};

/// Tests SIGTERM and Ctrl-C, each after half of this time, at least 2 s. Throws std::runtime_error on
/// failure.
PileResult runHardPile(std::chrono::seconds duration);

}  // namespace bench::attack
