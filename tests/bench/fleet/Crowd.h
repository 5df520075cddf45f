// The players of a fleet, in several processes, as one: one thread cannot serve a thousand of them as a
// player's own machine would.
//
// A process reads commands, a line each, and answers each with a line of numbers:
//
//   join AT_ONCE   they come, so many at a time         0
//   state                                               PLAYING LOSSES; "problem SENTENCE": one cannot join
//   kill PORT      that server is about to be killed    players who are there
//   waiting                                             of them, those who are not back yet
//   result                                              RETURNED DISTURBED MS... of those who are back
//   redirects                                           MS... of those who were sent on
//   leave          and it ends                          0
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/bench/capacity/suite/Worker.h"

namespace bench {

/// All of it throws std::runtime_error if one of the processes has ended, or a player cannot join.
class Crowd {
 public:
  /// `folder`: for the keys that they pin, each process in a file of its own.
  Crowd(const std::string& link, const std::filesystem::path& folder, int players, int processes);

  /// Have all come, some at a time. False: they do not in that time.
  bool joinAll(int at_once, std::chrono::seconds most);
  struct State {
    int playing = 0;
    int losses = 0;  ///< how often they have lost their servers
  };
  State state();
  /// From the directory's answer to the first picture, of each who was sent on, in milliseconds.
  std::vector<long> redirects();

  /// The server at this port is about to be killed. Return how many play there.
  int noteKill(std::uint16_t port);
  /// Wait until all of them play again, or for so long.
  void waitUntilBack(std::chrono::milliseconds most);
  struct Return {
    int returned = 0;        ///< as the same players
    int disturbed = 0;       ///< players of other servers that lost them meanwhile
    std::vector<long> back;  ///< milliseconds, of those who play again
  };
  Return result();
  void leaveAll();

 private:
  /// All processes' answers to a command.
  std::vector<std::vector<long>> ask(const std::string& command);
  long sumOf(const std::string& command);

  std::deque<capacity::Worker> m_workers;
  int m_players;
};

/// One of these processes, until "leave", or its input ends. Throws std::runtime_error for a link that is
/// none.
void serveCrowd(const std::string& link, const std::filesystem::path& known_servers, int first, int count);

}  // namespace bench
