// Runs a program of the build as a child process and collects its output.
#pragma once

#include <poll.h>
#include <signal.h>
#include <unistd.h>

#include <chrono>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/support/RunProgram.h"
#include "tests/support/Text.h"

namespace naiad::test {

class RunningProgram {
 public:
  static constexpr std::chrono::seconds kPatience{60};

  /// `words` are the program's name (or the full path of a program outside the build) and its arguments.
  explicit RunningProgram(std::vector<std::string> words) {
    if (!words.front().starts_with('/')) words.front() = NAIAD_BINARY_DIR "/" + words.front();
    int ends[2];
    if (pipe(ends) != 0) throw std::runtime_error("no pipe");
    const std::vector<char*> pointers = pointersTo(words);
    m_child = fork();
    if (m_child == 0) {
      dup2(ends[1], STDOUT_FILENO);
      dup2(ends[1], STDERR_FILENO);
      close(ends[0]);
      close(ends[1]);
      execv(pointers[0], pointers.data());
      _exit(127);
    }
    close(ends[1]);
    m_output = ends[0];
  }
  ~RunningProgram() {
    if (m_child > 0) ::kill(m_child, SIGKILL);
    finish();
  }
  RunningProgram(const RunningProgram&) = delete;
  RunningProgram& operator=(const RunningProgram&) = delete;

  /// Reads until `text` was printed `times` times. False if the program ends first, or after a minute.
  bool prints(const std::string& text, int times = 1) {
    const auto end = std::chrono::steady_clock::now() + kPatience;
    while (countIn(m_printed, text) < times) {
      if (std::chrono::steady_clock::now() > end || !read(100)) return false;
    }
    return true;
  }
  void signal(int number) const { ::kill(m_child, number); }
  /// Reads to the end. Returns the exit code, or 128 + the signal that ended the program.
  int finish() {
    if (m_child <= 0) return m_code;
    while (read(-1)) {
    }
    close(m_output);
    int status = 0;
    waitpid(m_child, &status, 0);
    m_child = 0;
    return m_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }
  const std::string& printed() const { return m_printed; }

 private:
  /// Collects output that arrives within this time. Returns false if the program has closed its output.
  bool read(int patience_ms) {
    pollfd waited{m_output, POLLIN, 0};
    if (::poll(&waited, 1, patience_ms) == 0) return true;
    char bytes[4096];
    const auto got = ::read(m_output, bytes, sizeof bytes);
    if (got <= 0) return false;
    m_printed.append(bytes, static_cast<std::size_t>(got));
    return true;
  }

  pid_t m_child = 0;
  int m_output = -1;
  int m_code = -1;
  std::string m_printed;
};

}  // namespace naiad::test
