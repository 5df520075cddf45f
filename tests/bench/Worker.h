// Programs of the measurements as child processes, whose output is read.
#pragma once

#include <chrono>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "tests/bench/Process.h"

namespace bench {

/// A program that reads commands and writes answers line by line. Functions throw std::runtime_error if the
/// program's output has ended.
class Worker {
 public:
  explicit Worker(const std::vector<std::string>& command) : Worker(command, Pipes()) {}
  /// Closes the program's input, and kills the program if it does not exit.
  ~Worker();
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  void tell(const std::string& line);
  /// Returns the program's next line. Throws after `patience`.
  std::string hear(std::chrono::seconds patience = std::chrono::seconds(30));
  /// Sends a line and returns the next line that begins with `word`.
  std::string ask(const std::string& line, const std::string& word,
                  std::chrono::seconds patience = std::chrono::seconds(30));
  /// Returns the processor time that the program has used, in microseconds.
  double cpu() const { return m_process.cpuMicros(); }

  struct End {
    int code = 0;        ///< exit code, or 128 + the signal that ended it
    std::string output;  ///< its stdout
  };
  /// Closes the program's input and reads its output to the end.
  End finish();

 private:
  struct Pipes {
    Pipes();
    int in[2];   ///< the program's input
    int out[2];  ///< its output
  };
  Worker(const std::vector<std::string>& command, const Pipes& pipes);
  bool read();

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
std::map<std::string, double> figuresOf(const std::string& line);

/// Removes the first line from `text`, without its line feed; nullopt if there is no complete line.
std::optional<std::string> popLine(std::string& text);

/// Appends the available input of this process to `text`, without waiting. False at the end of the input.
bool readInput(std::string& text);

}  // namespace bench
