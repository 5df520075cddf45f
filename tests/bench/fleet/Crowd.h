// The players of a fleet, in several processes (CrowdProcess.h), as one.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

namespace bench {

/// All of it throws std::runtime_error if one of the processes has ended, or a player cannot join.
class Crowd {
 public:
  /// `folder`: for the keys that they pin, each process in a file of its own.
  Crowd(const std::string& link, const std::filesystem::path& folder, int players, int processes);
  ~Crowd();
  Crowd(const Crowd&) = delete;
  Crowd& operator=(const Crowd&) = delete;

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
  struct Worker {
    pid_t process = -1;
    std::FILE* p_to = nullptr;
    std::FILE* p_from = nullptr;
  };
  static Worker start(const std::vector<std::string>& words);
  /// All processes' answers to a command.
  std::vector<std::vector<long>> ask(const std::string& command);
  long sumOf(const std::string& command);

  std::vector<Worker> m_workers;
  int m_players;
};

}  // namespace bench
