#include "host/program/RoundHandover.h"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <sstream>
#include <utility>
#include <vector>

#include "host/net/ListeningSockets.h"
#include "shared/net/base/Limits.h"
#include "shared/net/base/SafeText.h"

namespace naiad {

namespace {

/// For what waits for the disk, before it is read again.
constexpr std::chrono::seconds kSyncTime{5};
/// The game that is played comes first.
constexpr int kReplayNice = 10;
/// Of what dfreplay prints, its beginning.
constexpr std::size_t kMaxPrinted = std::size_t{64} << 10;
constexpr std::size_t kMaxProblem = 200;
/// Not to be started, as a shell has it.
constexpr int kNotStarted = 127;

constexpr std::string_view kProtocolKey = " protocol=";

/// The last line that begins so; with an empty `begin` the last one that is not empty.
std::string lineWith(const std::string& text, std::string_view begin) {
  std::istringstream lines(text);
  std::string found;
  for (std::string line; std::getline(lines, line);) {
    if (!line.empty() && line.starts_with(begin)) found = line;
  }
  return found;
}

std::string protocolProblem(const std::string& verified) {
  const std::size_t at = verified.find(kProtocolKey);
  if (at == std::string::npos) return "it does not say which protocol it speaks";
  const long protocol = std::strtol(verified.c_str() + at + kProtocolKey.size(), nullptr, 10);
  if (protocol == long{kProtocolVersion}) return {};
  return "it speaks protocol " + std::to_string(protocol) + ", and the players' clients speak " +
         std::to_string(kProtocolVersion);
}

}  // namespace

std::string readVerdict(int code, const std::string& printed) {
  if (code == 0) return protocolProblem(lineWith(printed, "verified "));
  if (code == kNotStarted) return "dfreplay, which tries that out, cannot be started";
  const std::string tick = code == 1 ? lineWith(printed, "tick ") : std::string();
  if (!tick.empty()) return safeText(tick, kMaxProblem);
  std::string last = lineWith(printed, "");
  while (last.ends_with('.')) last.pop_back();
  return last.empty() ? "dfreplay ended with code " + std::to_string(code) : safeText(last, kMaxProblem);
}

RoundHandover::RoundHandover(std::string program, std::string module, std::shared_ptr<Journals> journals)
    : m_program(std::move(program)), m_module(std::move(module)), m_journals(std::move(journals)) {}

RoundHandover::~RoundHandover() {
  {
    const std::lock_guard lock(m_mutex);
    m_ends = true;
    if (m_replay > 0) kill(m_replay, SIGKILL);
  }
  if (m_thread.joinable()) m_thread.join();
}

std::string RoundHandover::refusal() const {
  if (m_proving) return "that is being tried already";
  return m_journals->whyNotKept();
}

void RoundHandover::prove(std::function<void(const std::string& problem)> done) {
  if (m_thread.joinable()) m_thread.join();  // it has done its work
  m_proving = true;
  m_thread = std::thread([this, file = m_journals->currentFile(), done = std::move(done)] {
    const std::string problem = execute(file);
    m_proving = false;
    done(problem);
  });
}

std::string RoundHandover::execute(const std::string& file) {
  if (!m_journals->sync(kSyncTime)) return "the disk is too slow";
  m_proven_hash = hashOfModule(m_module);
  std::string printed;
  const int code = runReplay(file, printed);
  return readVerdict(code, printed);
}

// Its exit code.
int RoundHandover::runReplay(const std::string& file, std::string& printed) {
  const std::string replay = (std::filesystem::path(m_program).parent_path() / "dfreplay").string();
  const char* words[] = {"dfreplay", file.c_str(), "--verify", "--game", m_module.c_str(), nullptr};
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) return kNotStarted;
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, ends[1], STDERR_FILENO);
  pid_t child = 0;
  {
    const std::lock_guard lock(m_mutex);
    if (m_ends ||
        posix_spawn(&child, replay.c_str(), &actions, nullptr, const_cast<char* const*>(words), environ) != 0)
      child = 0;
    m_replay = child;
  }
  posix_spawn_file_actions_destroy(&actions);
  close(ends[1]);
  if (child > 0) setpriority(PRIO_PROCESS, static_cast<id_t>(child), kReplayNice);
  char part[4096];
  for (ssize_t got = 1; child > 0 && got != 0;) {
    got = read(ends[0], part, sizeof part);
    if (got < 0 && errno != EINTR) break;
    if (got > 0 && printed.size() < kMaxPrinted) printed.append(part, static_cast<std::size_t>(got));
  }
  close(ends[0]);
  if (child == 0) return kNotStarted;
  siginfo_t facts{};
  while (waitid(P_PID, static_cast<id_t>(child), &facts, WEXITED | WNOWAIT) != 0 && errno == EINTR) continue;
  const std::lock_guard lock(m_mutex);
  m_replay = 0;
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : kNotStarted;
}

void RoundHandover::leaveOpen(std::uint16_t port) {
  m_sockets = copyListeningSockets(port);
  m_journals->leaveOpen();
}

void RoundHandover::announce() const {
  m_journals->announceKept(m_proven_hash);
}

}  // namespace naiad
