// A program that reads commands and writes answers line by line.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <ctime>
#include <string>
#include <vector>

namespace bench::capacity {

class Worker {
 public:
  /// Starts the program. Throws std::runtime_error if that fails.
  explicit Worker(const std::vector<std::string>& command);
  /// Closes the program's input, and kills the program if it does not exit.
  ~Worker();
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  void tell(const std::string& line);
  /// Returns the program's next line. Throws std::runtime_error if its output has ended, or after `patience`.
  std::string hear(std::chrono::seconds patience = std::chrono::seconds(30));
  /// Sends a line and returns the next line, which must begin with `word`.
  std::string ask(const std::string& line, const std::string& word,
                  std::chrono::seconds patience = std::chrono::seconds(30));
  /// Returns the processor time that the program has used, in microseconds.
  double cpu() const;

 private:
  pid_t m_pid = 0;
  int m_in = -1;
  int m_out = -1;
  clockid_t m_clock{};
  std::string m_heard;
};

}  // namespace bench::capacity
