// A game with a main() of its own, as a real process that hosts itself.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "tests/support/TempFolder.h"

namespace naiad::test {

class GameProgram {
 public:
  /// Start `name` of the build's programs, in a session without a terminal, with these variables in its
  /// environment. It listens on a free port of 127.0.0.1, a tick takes 5 ms, and no round is written down.
  /// `arguments`: of its command line. `errors`: a descriptor for its standard error; below 0: the file of
  /// its output. It works in playFolder(), where nothing is.
  GameProgram(const std::string& name, std::map<std::string, std::string> environment,
              const std::vector<std::string>& arguments = {}, int errors = -1);
  /// SIGTERM, if it has not ended.
  ~GameProgram();
  GameProgram(const GameProgram&) = delete;
  GameProgram& operator=(const GameProgram&) = delete;

  std::uint16_t port() const { return m_port; }
  /// Wait for its end. Return its status, as of waitpid().
  int wait();
  void signal(int number) const;
  /// Its log so far.
  std::string log() const;
  /// Its key is in identity/key.pem there.
  std::filesystem::path directory() const { return m_directory.path(); }
  /// The socket for its commands.
  std::filesystem::path control() const { return m_directory / "control.sock"; }
  std::filesystem::path playFolder() const { return m_directory / "play"; }
  pid_t process() const { return m_process; }

 private:
  bool hasEnded();

  TempFolder m_directory;
  pid_t m_process = -1;
  int m_status = -1;
  std::uint16_t m_port = 0;
};

}  // namespace naiad::test
