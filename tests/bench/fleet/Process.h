// A program of the build as a process that is killed and restarted.
#pragma once

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/types.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace bench {

class Process {
 public:
  /// `words` are the program's name in the build's folder and its arguments. `output` is a file.
  Process(std::vector<std::string> words, std::filesystem::path output) {
    if (words.front().find('/') == std::string::npos) words.front() = NAIAD_BINARY_DIR "/" + words.front();
    std::vector<char*> pointers;
    for (std::string& word : words) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    m_child = ::fork();
    if (m_child != 0) return;
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    const int file = ::open(output.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600);
    ::dup2(file, STDOUT_FILENO);
    ::dup2(file, STDERR_FILENO);
    ::execv(pointers[0], pointers.data());
    ::_exit(127);
  }
  ~Process() { kill(); }
  Process(Process&& other) noexcept : m_child(std::exchange(other.m_child, -1)) {}
  Process& operator=(Process&&) = delete;

  bool isRunning() {
    if (m_child > 0 && ::waitpid(m_child, nullptr, WNOHANG) != 0) m_child = -1;
    return m_child > 0;
  }
  void signal(int number) const {
    if (m_child > 0) ::kill(m_child, number);
  }
  /// Sends SIGKILL and waits for the end.
  void kill() {
    signal(SIGKILL);
    wait();
  }
  /// Waits for the end after a signal. If it does not end in this time, kills it and returns false.
  bool waitForEnd(std::chrono::milliseconds most) {
    const auto end = std::chrono::steady_clock::now() + most;
    while (isRunning()) {
      if (std::chrono::steady_clock::now() > end) {
        kill();
        return false;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return true;
  }

 private:
  void wait() {
    if (m_child > 0) ::waitpid(m_child, nullptr, 0);
    m_child = -1;
  }

  pid_t m_child = -1;
};

}  // namespace bench
