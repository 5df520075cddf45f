// A program of the build, as a process that is killed and started again.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

namespace bench {

class Process {
 public:
  /// `words`: the program's name in the build's folder, and its arguments. Its output goes to a file.
  Process(std::vector<std::string> words, std::filesystem::path output);
  ~Process();
  Process(Process&& other) noexcept;
  Process& operator=(Process&&) = delete;

  bool isRunning();
  void signal(int number) const;
  /// SIGKILL, and its end.
  void kill();
  /// Wait for its end, after a signal. False: it does not within that time, and is killed.
  bool waitForEnd(std::chrono::milliseconds most);

 private:
  void wait();

  pid_t m_child = -1;
};

}  // namespace bench
