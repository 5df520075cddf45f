// A file that says what plays here, for lists of servers on the web: JSON, replaced in one step every few
// seconds.
//
// It has no names of players and no addresses but the one that is meant to be public. A thread of its own
// writes it, so that a disk that stalls costs the game nothing.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <string>
#include <thread>

#include "shared/program/LineLog.h"

namespace naiad {

/// What does not change while the server runs.
struct StatusFacts {
  std::string name;
  std::string game;
  std::size_t max_players = 0;
  bool asks_password = false;
  std::string link;  ///< for players elsewhere; empty: unknown, and left out
};

/// One line of JSON: name, game, players, max_players, password, protocol, version, and link if there is one.
/// ASCII, with the texts cleaned as those of players.
std::string statusText(const StatusFacts& facts, std::size_t players);

class StatusFile {
 public:
  static constexpr std::chrono::seconds kInterval{5};

  /// Writes the file for the first time. Throws std::runtime_error if it cannot be written.
  StatusFile(std::string path, StatusFacts facts);
  /// Removes the file: no server, no status.
  ~StatusFile();
  StatusFile(const StatusFile&) = delete;
  StatusFile& operator=(const StatusFile&) = delete;

  /// How many play. Does not wait for the disk. Any thread.
  void setPlayers(std::size_t players);
  /// What is new about writing, as a line of the log: that it fails, or works again; else empty. Any thread.
  std::string takeNews();

 private:
  void run();
  void write(std::size_t players);

  std::string m_path;
  StatusFacts m_facts;
  std::mutex m_mutex;
  std::condition_variable m_stop;
  std::size_t m_players = 0;
  std::string m_news;
  bool m_failing = false;
  bool m_stopping = false;
  std::thread m_thread;  ///< last: it uses the others
};

}  // namespace naiad
