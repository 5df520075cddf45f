// A file that says what plays here, for lists of servers on the web: JSON, replaced in one step every few
// seconds.
//
// It has no names of players and no addresses but the one that is meant to be public. A thread of its own
// writes it, so that a disk that stalls costs the game nothing.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <string>
#include <thread>

#include "shared/fleet/ServerFacts.h"

namespace naiad {

/// One line of JSON: name, game, players, max_players, password, protocol, version, and link if there is one.
/// `link`: for players elsewhere; empty: unknown, and left out. ASCII.
std::string statusText(const ServerFacts& facts, const std::string& link);

class StatusFile {
 public:
  static constexpr std::chrono::seconds kInterval{5};

  /// Writes the file for the first time. Throws std::runtime_error if it cannot be written.
  StatusFile(std::string path, ServerFacts facts, std::string link);
  /// Removes the file: no server, no status.
  ~StatusFile();

  /// How many play. Does not wait for the disk. Any thread.
  void setPlayers(std::uint32_t players);
  /// What is new about writing, as a line of the log: that it fails, or works again; else empty. Any thread.
  std::string takeNews();

 private:
  void run();
  void write(const ServerFacts& facts);

  std::string m_path;
  std::string m_link;
  std::mutex m_mutex;
  std::condition_variable m_stop;
  ServerFacts m_facts;
  std::string m_news;
  bool m_failing = false;
  bool m_stopping = false;
  std::thread m_thread;  ///< last: it uses the others
};

}  // namespace naiad
