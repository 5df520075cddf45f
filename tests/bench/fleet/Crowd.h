// The players of a fleet. They run in several processes, because one thread cannot serve a thousand of them
// as fast as each player's own machine would.
//
// A process reads commands, a line each, and answers each with a line of numbers:
//
//   join AT_ONCE   players join, this many at a time    0
//   state                                               PLAYING LOSSES; "problem SENTENCE": one cannot join
//   kill PORT      that server is about to be killed    number of players on it
//   waiting                                             number of these that are not back yet
//   result                                              RETURNED DISTURBED MS... (times of return)
//   redirects                                           MS... (times of redirects)
//   leave          the process ends                     0
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/bench/Worker.h"

namespace bench {

/// All functions throw std::runtime_error if one of the processes has ended, or a player cannot join.
class Crowd {
 public:
  /// Each process has a file in `folder` for the keys that its players pin.
  Crowd(const std::string& link, const std::filesystem::path& folder, int players, int processes);

  /// Lets the players join, at most `at_once` at a time. False if they have not all joined in time.
  bool joinAll(int at_once, std::chrono::seconds most);
  struct State {
    int playing = 0;
    int losses = 0;  ///< total number of times that players have lost their servers
  };
  State state();
  /// Returns each redirected player's time from the directory's answer to the first picture, in milliseconds.
  std::vector<long> redirects();

  /// Call before the server at this port is killed. Returns how many players it has.
  int noteKill(std::uint16_t port);
  /// Waits until all players of the killed server play again, but at most for this time.
  void waitUntilBack(std::chrono::milliseconds most);
  struct Return {
    int returned = 0;        ///< players of the killed server that play again as the same players
    int disturbed = 0;       ///< how often players of other servers lost their servers
    std::vector<long> back;  ///< milliseconds until the player was back, for each that plays again
  };
  Return result();
  void leaveAll();

 private:
  /// Returns all processes' answers to a command.
  std::vector<std::vector<long>> ask(const std::string& command);
  long sumOf(const std::string& command);

  std::deque<Worker> m_workers;
  int m_players;
};

/// Runs one of the crowd's processes until it reads "leave" or its input ends. Throws std::runtime_error for
/// an invalid link.
void serveCrowd(const std::string& link, const std::filesystem::path& known_servers, int first, int count);

}  // namespace bench
