// A program that is told what to do line by line, and answers so.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <ctime>
#include <string>
#include <vector>

namespace bench::capacity {

class Worker {
 public:
  /// Throws std::runtime_error if it cannot be started.
  explicit Worker(const std::vector<std::string>& command);
  /// Closes its input, and ends it by force if that does not.
  ~Worker();
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  void tell(const std::string& line);
  /// The next line. Throws std::runtime_error at the end, or if it takes too long.
  std::string hear(std::chrono::seconds patience = std::chrono::seconds(30));
  /// Tell, and hear the line that begins with `word`.
  std::string ask(const std::string& line, const std::string& word,
                  std::chrono::seconds patience = std::chrono::seconds(30));
  /// Microseconds of processor time it has used.
  double cpu() const;

 private:
  pid_t m_pid = 0;
  int m_in = -1;
  int m_out = -1;
  clockid_t m_clock{};
  std::string m_heard;
};

}  // namespace bench::capacity
