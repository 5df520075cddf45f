// dfserver as people start it: a process with shipped settings, TLS, and its log in a pipe.
#pragma once

#include <sys/types.h>

#include <atomic>
#include <cstdint>
#include <map>
#include <string>
#include <thread>
#include <vector>

namespace bench::attack {

/// What differs from a server without options.
struct ServerSetup {
  std::vector<std::string> arguments;
  std::string password;  ///< empty: none
};

class ServerProcess {
 public:
  using Counters = std::map<std::string, double>;

  /// Starts it, with an identity and a truth file in `folder`, and waits until it listens. Throws
  /// std::runtime_error.
  ServerProcess(const ServerSetup& setup, const std::string& folder);
  /// Kills it if it still runs.
  ~ServerProcess();

  std::uint16_t port() const { return m_port; }
  const std::string& fingerprint() const { return m_fingerprint; }
  const std::string& password() const { return m_password; }
  const std::string& truthFile() const { return m_truth_file; }
  bool isRunning();
  /// Of all its threads, since it began; 0 if it is not there.
  double cpuSeconds() const;

  /// From now on the log is not read, and its pipe is full.
  void stallLog();
  /// The reader of the log ends.
  void closeLog();

  /// Ask it to end (the log is read again), and kill it after ten seconds. The counters of its last line;
  /// none if there was no such line.
  Counters stop();
  /// Did it end before it was asked to?
  bool hasDied() const { return m_died; }
  /// The end of its log.
  const std::string& log() const { return m_log; }

 private:
  enum class LogMode { kRead, kStalled, kClosed, kFinish };
  void readLog();
  void setMode(LogMode mode);
  void waitForJoinFile(const std::string& path);

  std::string m_password;
  std::string m_truth_file;
  std::string m_fingerprint;
  std::uint16_t m_port = 0;
  pid_t m_pid = -1;
  bool m_died = false;
  int m_log_in = -1;   ///< the pipe's end that is read
  int m_log_out = -1;  ///< the server's end, kept to fill the pipe
  std::atomic<LogMode> m_mode{LogMode::kRead};
  std::atomic<LogMode> m_mode_seen{LogMode::kRead};  ///< by the thread
  std::string m_log;                                 ///< the thread's until it has finished
  std::thread m_reader;
};

}  // namespace bench::attack
