// A game with its own main(), as a real process that hosts itself.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/RunProgram.h"
#include "tests/support/TempFolder.h"

namespace naiad::test {

/// Runs dfctl with these arguments. Returns its exit code and its output, including standard error.
inline std::pair<int, std::string> runCtl(const std::string& arguments) {
  return runProgram(std::string(NAIAD_BINARY_DIR) + "/dfctl " + arguments + " 2>&1 </dev/null");
}

class GameProgram {
 public:
  /// Starts program `name` of the build in its own session without a terminal, in playFolder(), which is
  /// empty. The default environment lets it listen on a free port of 127.0.0.1, with ticks of 5 ms, and
  /// record no round; `environment` adds variables or replaces these. `arguments` are those of its command
  /// line. `errors` is a descriptor for its standard error, which below 0 goes to the file of its output.
  GameProgram(const std::string& name, std::map<std::string, std::string> environment,
              const std::vector<std::string>& arguments = {}, int errors = -1);
  /// If the program has not ended, sends SIGTERM and waits for its end.
  ~GameProgram();
  GameProgram(const GameProgram&) = delete;
  GameProgram& operator=(const GameProgram&) = delete;

  std::uint16_t port() const { return m_port; }
  /// Waits until the program ends. Returns its status as from waitpid().
  int wait();
  void signal(int number) const;
  /// Sends a signal and waits until the program ends. Returns its status as from waitpid().
  int end(int number) {
    signal(number);
    return wait();
  }
  /// Returns the program's log and output so far.
  std::string log() const;
  /// Returns the folder with the program's files, for example its key, identity/key.pem.
  std::filesystem::path directory() const { return m_directory.path(); }
  /// Returns the path of the program's control socket.
  std::filesystem::path control() const { return m_directory / "control.sock"; }
  /// Gives the program a command with the real dfctl. Returns its exit code and output.
  std::pair<int, std::string> ctl(const std::string& words) const {
    return runCtl("--control " + control().string() + " " + words);
  }
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
