// dfserver as a process with default settings, TLS, and its log in a pipe.
#pragma once

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "tests/bench/Process.h"
#include "tests/bench/Worker.h"

extern char** environ;

namespace bench::attack {

/// Returns a program's path; NAIAD_ATTACK_DFSERVER and NAIAD_ATTACK_DFCLIENT select another version.
inline std::string programAt(const char* variable, const char* name) {
  const char* other = std::getenv(variable);
  return other != nullptr ? other : std::string(NAIAD_BINARY_DIR) + "/" + name;
}
inline std::string serverProgram() {
  return programAt("NAIAD_ATTACK_DFSERVER", "dfserver");
}
inline std::string clientProgram() {
  return programAt("NAIAD_ATTACK_DFCLIENT", "dfclient");
}

/// Settings of a server, in addition to the defaults.
struct ServerSetup {
  std::vector<std::string> arguments;
  std::string password;  ///< empty: none
};

class ServerProcess {
 public:
  /// Starts the server with an identity and a truth file in `folder`, and waits until it listens. Throws
  /// std::runtime_error.
  ServerProcess(const ServerSetup& setup, const std::string& folder)
      : m_password(setup.password), m_truth_file(folder + "/truth") {
    const std::string join_file = folder + "/join";
    std::filesystem::remove(join_file);  // of an earlier server in this folder
    std::vector<std::string> command{
        serverProgram(),   "--port",      "0",       "--identity",   folder + "/identity", "--state",
        folder + "/state", "--join-file", join_file, "--truth-file", m_truth_file};
    command.insert(command.end(), setup.arguments.begin(), setup.arguments.end());
    // The environment is this process's without settings of servers.
    std::vector<std::string> entries;
    for (char** p = environ; *p != nullptr; ++p) {
      if (!std::string_view(*p).starts_with("NAIAD_")) entries.emplace_back(*p);
    }
    if (!m_password.empty()) entries.push_back("NAIAD_PASSWORD=" + m_password);
    std::vector<char*> environment = argvOf(entries);
    std::array<int, 2> ends{};
    if (pipe2(ends.data(), O_CLOEXEC) != 0) throw std::runtime_error("a pipe cannot be made");
    m_log_in = ends[0];
    m_log_out = ends[1];
    m_process.emplace(command, [this, &environment] {
      dup2(open("/dev/null", O_RDONLY | O_CLOEXEC), STDIN_FILENO);
      dup2(m_log_out, STDOUT_FILENO);
      dup2(m_log_out, STDERR_FILENO);
      ::signal(SIGPIPE, SIG_DFL);
      environ = environment.data();
    });
    m_reader = std::thread([this] { readLog(); });
    try {
      waitForJoinFile(join_file);
    } catch (...) {
      stop();
      throw;
    }
  }
  ~ServerProcess() { stop(); }

  std::uint16_t port() const { return m_port; }
  const std::string& fingerprint() const { return m_fingerprint; }
  const std::string& password() const { return m_password; }
  const std::string& truthFile() const { return m_truth_file; }
  bool isRunning() { return m_process->isRunning(); }
  /// Returns the CPU time of all the server's threads since its start.
  double cpuMicros() const { return m_process->cpuMicros(); }

  /// Stops reading the log and fills its pipe.
  void stallLog() {
    setMode(LogMode::kStalled);
    // The pipe is opened again, because O_NONBLOCK affects all descriptors of an open file, and writes by the
    // server must block.
    const std::string name = "/proc/self/fd/" + std::to_string(m_log_out);
    const int filler = open(name.c_str(), O_WRONLY | O_NONBLOCK | O_CLOEXEC);
    if (filler < 0) throw std::runtime_error("the pipe of the log cannot be filled");
    const std::string dots(1024, '.');
    while (write(filler, dots.data(), dots.size()) > 0) {
    }
    while (write(filler, "\n", 1) > 0) {
    }
    close(filler);
  }
  /// Closes the read end of the log's pipe, like a reader that exits.
  void closeLog() { setMode(LogMode::kClosed); }

  void killNow() { m_process->kill(); }
  /// Asks the server to stop (its log is read again), and kills it after ten seconds. Returns the counters of
  /// its last line; empty if that line is missing.
  std::map<std::string, double> stop() {
    if (!m_reader.joinable()) return {};
    if (m_mode == LogMode::kStalled) setMode(LogMode::kRead);
    m_process->signal(SIGTERM);
    m_process->waitForEnd(std::chrono::seconds(10));
    m_mode = LogMode::kFinish;
    m_reader.join();
    close(std::exchange(m_log_out, -1));
    const std::size_t last = m_log.rfind("stopped: ");
    if (last == std::string::npos) return {};
    return figuresOf(m_log.substr(last, m_log.find('\n', last) - last));
  }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr std::size_t kMaxLog = std::size_t{1} << 20;  ///< bytes of the log that are kept
  enum class LogMode { kRead, kStalled, kClosed, kFinish };
  void readLog() {
    for (;;) {
      const LogMode mode = m_mode;
      if (mode == LogMode::kClosed && m_log_in >= 0) {
        close(m_log_in);
        m_log_in = -1;
      }
      m_mode_seen = mode;
      pollfd wait{mode == LogMode::kStalled ? -1 : m_log_in, POLLIN, 0};
      const int ready = poll(&wait, 1, 10);
      if (ready > 0) {
        std::array<char, 65536> bytes;
        const ssize_t size = read(m_log_in, bytes.data(), bytes.size());
        if (size > 0) m_log.append(bytes.data(), static_cast<std::size_t>(size));
        if (m_log.size() > kMaxLog) m_log.erase(0, m_log.size() - kMaxLog / 2);
      } else if (mode == LogMode::kFinish) {
        break;
      }
    }
    if (m_log_in >= 0) close(m_log_in);
    m_log_in = -1;
  }
  void setMode(LogMode mode) {
    m_mode = mode;
    while (m_mode_seen != mode) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  void waitForJoinFile(const std::string& path) {
    for (const auto end = Clock::now() + std::chrono::seconds(30); Clock::now() < end;
         std::this_thread::sleep_for(std::chrono::milliseconds(10))) {
      std::ifstream file(path);
      std::string address, flag;
      if (file >> address >> flag >> m_fingerprint && m_fingerprint.size() == 64) {
        m_port = static_cast<std::uint16_t>(std::stoi(address.substr(address.rfind(':') + 1)));
        return;
      }
      if (!isRunning()) break;
    }
    throw std::runtime_error("dfserver does not start");
  }

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
