// Programs of the measurements as child processes, whose output is read.
#pragma once

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <map>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "tests/bench/Process.h"

namespace bench {

/// Removes the first line from `text`, without its line feed; nullopt if there is no complete line.
inline std::optional<std::string> popLine(std::string& text) {
  const std::size_t end = text.find('\n');
  if (end == std::string::npos) return std::nullopt;
  std::string line = text.substr(0, end);
  text.erase(0, end + 1);
  return line;
}

/// A program that reads commands and writes answers line by line. Functions throw std::runtime_error if the
/// program's output has ended.
class Worker {
 public:
  explicit Worker(const std::vector<std::string>& command) : Worker(command, Pipes()) {}
  /// Closes the program's input, and kills the program if it does not exit.
  ~Worker() {
    if (m_in >= 0) close(m_in);
    close(m_out);
    m_process.waitForEnd(std::chrono::seconds(3));
  }
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  void tell(const std::string& line) {
    const std::string text = line + "\n";
    if (write(m_in, text.data(), text.size()) != static_cast<ssize_t>(text.size())) {
      throw std::runtime_error("a program of the measurement has ended");
    }
  }
  /// Returns the program's next line. Throws after `patience`.
  std::string hear(std::chrono::seconds patience = std::chrono::seconds(30)) {
    const auto end = std::chrono::steady_clock::now() + patience;
    for (;;) {
      if (auto line = popLine(m_heard)) return *line;
      const auto left =
          std::chrono::duration_cast<std::chrono::milliseconds>(end - std::chrono::steady_clock::now());
      pollfd wait{m_out, POLLIN, 0};
      if (left.count() <= 0 || poll(&wait, 1, static_cast<int>(left.count())) <= 0) {
        throw std::runtime_error("a program of the measurement says nothing");
      }
      if (!read()) throw std::runtime_error("a program of the measurement has ended");
    }
  }
  /// Sends a line and returns the next line that begins with `word`.
  std::string ask(const std::string& line, const std::string& word,
                  std::chrono::seconds patience = std::chrono::seconds(30)) {
    tell(line);
    for (;;) {
      std::string heard = hear(patience);
      if (heard.starts_with(word)) return heard;
      if (heard == "failed") throw std::runtime_error("a program of the measurement failed");
    }
  }
  /// Returns the processor time that the program has used, in microseconds.
  double cpu() const { return m_process.cpuMicros(); }

  struct End {
    int code = 0;        ///< exit code, or 128 + the signal that ended it
    std::string output;  ///< its stdout
  };
  /// Closes the program's input and reads its output to the end.
  End finish() {
    close(std::exchange(m_in, -1));
    while (read()) {
    }
    const int code = m_process.wait();
    return {code, std::move(m_heard)};
  }

 private:
  struct Pipes {
    Pipes() {
      if (pipe2(in, O_CLOEXEC) != 0 || pipe2(out, O_CLOEXEC) != 0)
        throw std::runtime_error("a pipe cannot be made");
    }
    int in[2];   ///< the program's input
    int out[2];  ///< its output
  };
  Worker(const std::vector<std::string>& command, const Pipes& pipes)
      : m_in(pipes.in[1]), m_out(pipes.out[0]), m_process(command, [&pipes] {
          dup2(pipes.in[0], STDIN_FILENO);
          dup2(pipes.out[1], STDOUT_FILENO);
        }) {
    close(pipes.in[0]);
    close(pipes.out[1]);
  }
  /// Appends the next output to m_heard. False at its end.
  bool read() {
    std::array<char, 65536> bytes;
    const ssize_t size = ::read(m_out, bytes.data(), bytes.size());
    if (size > 0) m_heard.append(bytes.data(), static_cast<std::size_t>(size));
    return size > 0;
  }

  int m_in;
  int m_out;
  Process m_process;
  std::string m_heard;
};

/// Runs a command to its end. Its stderr goes to ours.
inline Worker::End runProgram(const std::vector<std::string>& command) {
  return Worker(command).finish();
}

/// Returns the values of a line "word key=value key=value", by key.
inline std::map<std::string, double> figuresOf(const std::string& line) {
  std::map<std::string, double> figures;
  std::istringstream words(line);
  for (std::string word; words >> word;) {
    const std::size_t equals = word.find('=');
    if (equals != std::string::npos) figures[word.substr(0, equals)] = std::stod(word.substr(equals + 1));
  }
  return figures;
}

/// Appends the available input of this process to `text`, without waiting. False at the end of the input.
inline bool readInput(std::string& text) {
  pollfd ready{STDIN_FILENO, POLLIN, 0};
  while (poll(&ready, 1, 0) == 1) {
    std::array<char, 256> bytes;
    const ssize_t size = read(STDIN_FILENO, bytes.data(), bytes.size());
    if (size <= 0) return false;
    text.append(bytes.data(), static_cast<std::size_t>(size));
  }
  return true;
}

}  // namespace bench
