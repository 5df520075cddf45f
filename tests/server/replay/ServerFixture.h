// A test fixture that runs a real dfserver and other programs in a temporary folder.
#pragma once

#include <gtest/gtest.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "host/journal/DfrReader.h"
#include "tests/server/host/admin/Talk.h"
#include "tests/support/RunProgram.h"
#include "tests/support/TempFolder.h"
#include "tests/support/Text.h"
#include "tests/support/WaitUntil.h"

namespace naiad::test {

class ServerFixture : public testing::Test {
 protected:
  /// Starts a program (name in the build, or path) in the folder. Its output is appended to `p_output`.
  pid_t run(std::vector<std::string> words, const char* p_output = "out.txt",
            const std::map<std::string, std::string>& environment = {}) const {
    const pid_t process = fork();
    if (process != 0) return process;
    if (chdir(folder.path().c_str()) != 0) _exit(126);
    [[maybe_unused]] const bool out = freopen(p_output, "a", stdout) != nullptr;
    [[maybe_unused]] const bool err = freopen(p_output, "a", stderr) != nullptr;
    setenv("HOME", folder.path().c_str(), 1);
    for (const auto& [name, value] : environment) setenv(name.c_str(), value.c_str(), 1);
    if (words.front().front() != '/') words.front() = NAIAD_BINARY_DIR "/" + words.front();
    execv(words.front().c_str(), pointersTo(words).data());
    _exit(127);
  }
  /// Ends a process with a signal, and sets `process` to 0.
  static void end(pid_t& process, int signal) {
    kill(process, signal);
    waitpid(std::exchange(process, 0), nullptr, 0);
  }
  std::string log() const { return contentOf(folder / "out.txt"); }
  bool isLogged(const std::string& text) const {
    return waitUntil([&] { return log().find(text) != std::string::npos; });
  }
  /// Returns the port in the server's --port-file=port; "0" if there was no server yet.
  std::string port() const { return std::to_string(std::atoi(contentOf(folder / "port").c_str())); }
  /// Returns the number with this name in the reply to `dfctl status`, from the server's
  /// --control=control.sock.
  long status(const std::string& name) const {
    const std::string answer = Talk(folder / "control.sock").ask(R"({"command":"status"})");
    const std::size_t at = answer.find("\"" + name + "\":");
    return at == std::string::npos ? -1 : std::atol(answer.c_str() + at + name.size() + 3);
  }
  /// Waits until the worlds, which miss ticks if they are slow, have played this many more on average.
  bool playTicks(long count) const {
    const long ticks = status("ticks"), missed = status("missed_ticks");
    return waitUntil([&] {
      const long rooms = std::max(1L, status("rooms"));
      const long left_out = status("missed_ticks") - missed;  // by all rooms
      return rooms * (status("ticks") - ticks - count) >= left_out;
    });
  }
  /// Returns the file in the server's --journal=rounds; an empty path if not found.
  std::filesystem::path round() const {
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(folder / "rounds", error))
      return entry.path();
    return {};
  }
  static std::size_t countTurns(const std::filesystem::path& round) {
    const std::string bytes = contentOf(round);
    DfrReader reader(bytes);
    std::size_t turns = 0;
    while (const auto record = reader.next()) turns += std::holds_alternative<WorldTurn>(*record) ? 1 : 0;
    return turns;
  }

  TempFolder folder;
  pid_t server = 0;
};

}  // namespace naiad::test
