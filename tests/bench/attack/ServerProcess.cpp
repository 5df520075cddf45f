#include "ServerProcess.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string_view>

#include "../path/Argv.h"
#include "Programs.h"

extern char** environ;

namespace bench::attack {
namespace {

using Clock = std::chrono::steady_clock;
using namespace std::chrono_literals;

constexpr std::size_t kMaxLog = std::size_t{1} << 20;  // bytes of the log that are kept

/// Returns this process's environment, without server settings but with this password.
std::vector<std::string> environmentWith(const std::string& password) {
  std::vector<std::string> entries;
  for (char** p = environ; *p != nullptr; ++p) {
    if (!std::string_view(*p).starts_with("NAIAD_")) entries.emplace_back(*p);
  }
  if (!password.empty()) entries.push_back("NAIAD_PASSWORD=" + password);
  return entries;
}

}  // namespace

ServerProcess::ServerProcess(const ServerSetup& setup, const std::string& folder)
    : m_password(setup.password), m_truth_file(folder + "/truth") {
  const std::string join_file = folder + "/join";
  std::filesystem::remove(join_file);  // of an earlier server in this folder
  std::vector<std::string> command{
      serverProgram(),   "--port",      "0",       "--identity",   folder + "/identity", "--state",
      folder + "/state", "--join-file", join_file, "--truth-file", m_truth_file};
  command.insert(command.end(), setup.arguments.begin(), setup.arguments.end());
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) throw std::runtime_error("a pipe cannot be made");
  m_log_in = ends[0];
  m_log_out = ends[1];
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, m_log_out, STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, m_log_out, STDERR_FILENO);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t usual;
  sigemptyset(&usual);
  sigaddset(&usual, SIGPIPE);
  posix_spawnattr_setsigdefault(&attributes, &usual);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF);
  std::vector<std::string> entries = environmentWith(m_password);
  const int error = posix_spawn(&m_pid, command[0].c_str(), &actions, &attributes,
                                path::argvOf(command).data(), path::argvOf(entries).data());
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) throw std::runtime_error(command[0] + " cannot be run");
  m_reader = std::thread([this] { readLog(); });
  try {
    waitForJoinFile(join_file);
  } catch (...) {
    stop();
    close(m_log_out);
    throw;
  }
}

ServerProcess::~ServerProcess() {
  if (m_reader.joinable()) stop();
  close(m_log_out);
}

void ServerProcess::waitForJoinFile(const std::string& path) {
  for (const auto end = Clock::now() + 30s; Clock::now() < end; std::this_thread::sleep_for(10ms)) {
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

bool ServerProcess::isRunning() {
  if (m_pid < 0 || m_died) return false;
  m_died = waitpid(m_pid, nullptr, WNOHANG) == m_pid;
  return !m_died;
}

double ServerProcess::cpuSeconds() const {
  clockid_t clock = 0;
  timespec time{};
  if (clock_getcpuclockid(m_pid, &clock) != 0 || clock_gettime(clock, &time) != 0) return 0;
  return static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_nsec) / 1e9;
}

// ---- the log ----------------------------------------------------------------------------------------------

void ServerProcess::readLog() {
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

void ServerProcess::setMode(LogMode mode) {
  m_mode = mode;
  while (m_mode_seen != mode) std::this_thread::sleep_for(1ms);
}

void ServerProcess::stallLog() {
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

void ServerProcess::closeLog() {
  setMode(LogMode::kClosed);
}

// ---- shutdown ---------------------------------------------------------------------------------------------

void ServerProcess::killNow() {
  if (!isRunning()) return;
  kill(m_pid, SIGKILL);
  waitpid(m_pid, nullptr, 0);
  m_died = true;
}

ServerProcess::Counters ServerProcess::stop() {
  if (m_mode == LogMode::kStalled) setMode(LogMode::kRead);
  if (isRunning()) {
    kill(m_pid, SIGTERM);
    const auto end = Clock::now() + 10s;
    while (waitpid(m_pid, nullptr, WNOHANG) == 0) {
      if (Clock::now() > end) {
        kill(m_pid, SIGKILL);
        waitpid(m_pid, nullptr, 0);
        break;
      }
      std::this_thread::sleep_for(5ms);
    }
  }
  m_pid = -1;
  m_mode = LogMode::kFinish;
  if (m_reader.joinable()) m_reader.join();
  Counters counters;
  const std::size_t last = m_log.rfind("stopped: ");
  if (last == std::string::npos) return counters;
  std::istringstream words(m_log.substr(last, m_log.find('\n', last) - last));
  for (std::string word; words >> word;) {
    const std::size_t equals = word.find('=');
    if (equals != std::string::npos) counters[word.substr(0, equals)] = std::stod(word.substr(equals + 1));
  }
  return counters;
}

}  // namespace bench::attack
