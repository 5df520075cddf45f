// A game with its own main(), as a real process that hosts itself.
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
  /// Starts program `name` of the build in its own session without a terminal. It listens on a free port of
  /// 127.0.0.1, a tick takes 5 ms, and no round is recorded. `environment` is added to that, `arguments` are
  /// those of its command line. `errors` is a descriptor for its standard error; below 0, that goes to the
  /// file of its output. It runs in playFolder(), which is empty.
  GameProgram(const std::string& name, std::map<std::string, std::string> environment,
              const std::vector<std::string>& arguments = {}, int errors = -1);
  /// Sends SIGTERM if the program has not ended.
  ~GameProgram();
  GameProgram(const GameProgram&) = delete;
  GameProgram& operator=(const GameProgram&) = delete;

  std::uint16_t port() const { return m_port; }
  /// Waits for its end. Returns its status as from waitpid().
  int wait();
  void signal(int number) const;
  /// Returns its log so far.
  std::string log() const;
  /// Returns the folder that has its key in identity/key.pem.
  std::filesystem::path directory() const { return m_directory.path(); }
  /// Returns the path of its control socket.
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
