// A JSON file with the server's status, for server lists on the web, replaced atomically every 5 seconds.
//
// It contains no names of players and no address except the public one (--public-host). A thread of its own
// writes it, so a slow disk does not delay the game.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <string>
#include <thread>

#include "shared/fleet/ServerInfo.h"

namespace naiad {

/// Returns one line of ASCII JSON: name, game, players, max_players, password, protocol, version, and link.
/// `link`: a link for players on other machines; omitted if empty.
std::string statusText(const ServerInfo& facts, const std::string& link);

class StatusFile {
 public:
  static constexpr std::chrono::seconds kInterval{5};

  /// Writes the file for the first time. Throws std::runtime_error if it cannot be written.
  StatusFile(std::string path, ServerInfo facts, std::string link);
  /// Removes the file.
  ~StatusFile();

  /// Sets the number of players. Does not wait for the disk. Any thread.
  void setPlayers(std::uint32_t players);
  /// Returns a log line, once, if writing has begun to fail or works again; else empty. Any thread.
  std::string popLogMessage();

 private:
  void run();
  void write(const ServerInfo& facts);

  std::string m_path;
  std::string m_link;
  std::mutex m_mutex;
  std::condition_variable m_stop;
  ServerInfo m_facts;
  std::string m_log_message;
  bool m_failing = false;
  bool m_stopping = false;
  std::thread m_thread;  ///< last member, because it uses the others
};

}  // namespace naiad
