// dfserver as a process with default settings, TLS, and its log in a pipe.
#pragma once

#include <atomic>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "tests/bench/Process.h"

namespace bench::attack {

/// Settings of a server, in addition to the defaults.
struct ServerSetup {
  std::vector<std::string> arguments;
  std::string password;  ///< empty: none
};

class ServerProcess {
 public:
  /// Starts the server with an identity and a truth file in `folder`, and waits until it listens. Throws
  /// std::runtime_error.
  ServerProcess(const ServerSetup& setup, const std::string& folder);
  ~ServerProcess() { stop(); }

  std::uint16_t port() const { return m_port; }
  const std::string& fingerprint() const { return m_fingerprint; }
  const std::string& password() const { return m_password; }
  const std::string& truthFile() const { return m_truth_file; }
  bool isRunning() { return m_process->isRunning(); }
  /// Returns the CPU time of all the server's threads since its start.
  double cpuMicros() const { return m_process->cpuMicros(); }

  /// Stops reading the log and fills its pipe.
  void stallLog();
  /// Closes the read end of the log's pipe, like a reader that exits.
  void closeLog() { setMode(LogMode::kClosed); }

  void killNow() { m_process->kill(); }
  /// Asks the server to stop (its log is read again), and kills it after ten seconds. Returns the counters of
  /// its last line; empty if that line is missing.
  std::map<std::string, double> stop();

 private:
  enum class LogMode { kRead, kStalled, kClosed, kFinish };
  void readLog();
  void setMode(LogMode mode);
  void waitForJoinFile(const std::string& path);

  std::string m_password;
  std::string m_truth_file;
  std::string m_fingerprint;
  std::uint16_t m_port = 0;
  std::optional<Process> m_process;
  int m_log_in = -1;   ///< read end of the pipe
  int m_log_out = -1;  ///< the server's end, kept to fill the pipe
  std::atomic<LogMode> m_mode{LogMode::kRead};
  std::atomic<LogMode> m_mode_seen{LogMode::kRead};  ///< mode that the log's thread now uses
  std::string m_log;  ///< the log's end; owned by the thread until it has finished
  std::thread m_reader;
};

}  // namespace bench::attack
