#include "host/program/LocalClient.h"

#include <dlfcn.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <sstream>
#include <string_view>
#include <system_error>

#include "host/world/ArgvPointers.h"

namespace naiad {

namespace {

namespace fs = std::filesystem;

// Flushes the output that the game has printed so far, to the place where it was printed.
void flushAll() {
  std::cout.flush();
  std::clog.flush();
  std::fflush(stdout);
}

// Opens a regular file, otherwise /dev/null, because a pipe without a reader would block the game.
int openOrNull(const std::string& path) {
  const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC | O_NONBLOCK, 0640);
  struct stat facts {};
  if (file >= 0 && fstat(file, &facts) == 0 && S_ISREG(facts.st_mode)) return file;
  if (file >= 0) ::close(file);
  return ::open("/dev/null", O_WRONLY | O_CLOEXEC);
}

constexpr int kExitTimeoutMillis = 2000;  // time for a client to end after the game's goodbye

bool isProgram(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(path, error) && access(path.c_str(), X_OK) == 0;
}

/// Returns the folder of this library.
fs::path ownFolder() {
  Dl_info info{};
  if (dladdr(reinterpret_cast<void*>(&isProgram), &info) == 0 || info.dli_fname == nullptr) return {};
  std::error_code error;
  return fs::canonical(info.dli_fname, error).parent_path();
}

/// True if dfclient's exit status means that it did not play (client/session/TrustOptions.h): wrong usage,
/// unreachable, refused, no terminal.
bool meansFailure(int status) {
  const int code = WIFEXITED(status) ? WEXITSTATUS(status) : 0;
  return code != 0 && code != 4;
}

/// Returns this process's environment without variables about another server, and with NAIAD_PASSWORD if
/// `password` is not empty.
std::vector<std::string> environmentOfClient(const std::string& password) {
  std::vector<std::string> kept;
  for (char** p = environ; *p != nullptr; ++p) {
    const std::string_view entry(*p);
    const bool other = entry.starts_with("NAIAD_GAME=") || entry.starts_with("NAIAD_FINGERPRINT=") ||
                       entry.starts_with("NAIAD_PASSWORD=");
    if (!other) kept.emplace_back(entry);
  }
  if (!password.empty()) kept.push_back("NAIAD_PASSWORD=" + password);
  return kept;
}

}  // namespace

OutputRedirect::OutputRedirect(const std::string& path) {
  flushAll();
  const bool errors_too = isatty(STDERR_FILENO) == 1;
  for (int n = 0; n < 3; ++n) {
    m_saved[n] = fcntl(n, F_DUPFD_CLOEXEC, 3);
    if (m_saved[n] >= 0 || (n == STDERR_FILENO && !errors_too)) continue;
    const int problem = errno;
    for (const int saved : m_saved) {
      if (saved >= 0) close(saved);
    }
    throw std::system_error(problem, std::generic_category(), "cannot duplicate the terminal's descriptors");
  }
  const int nothing = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
  const int file = openOrNull(path);
  if (nothing >= 0) dup2(nothing, STDIN_FILENO);
  if (file >= 0) dup2(file, STDOUT_FILENO);
  if (file >= 0 && errors_too) dup2(file, STDERR_FILENO);
  if (nothing >= 0) close(nothing);
  if (file >= 0) close(file);
}

OutputRedirect::~OutputRedirect() {
  flushAll();
  for (int n = 0; n < 3; ++n) {
    if (m_saved[n] < 0) continue;
    dup2(m_saved[n], n);
    close(m_saved[n]);
  }
}

bool LocalClient::hasTerminal() {
  const char* p_term = std::getenv("TERM");
  return p_term != nullptr && *p_term != '\0' && isatty(STDIN_FILENO) == 1 && isatty(STDOUT_FILENO) == 1 &&
         tcgetpgrp(STDIN_FILENO) == getpgrp();
}

std::optional<fs::path> LocalClient::findProgram() {
  if (const char* p_named = std::getenv("NAIAD_CLIENT")) {
    return isProgram(p_named) ? std::optional<fs::path>(p_named) : std::nullopt;
  }
  const fs::path own = ownFolder();
  for (const char* bin : {"../bin", "../../bin"}) {  // relative to lib, or lib/x86_64-linux-gnu
    if (const fs::path path = own / bin / "dfclient"; isProgram(path)) return path.lexically_normal();
  }
  const char* p_path = std::getenv("PATH");
  std::istringstream folders(p_path != nullptr ? p_path : "");
  for (std::string folder; std::getline(folders, folder, ':');) {
    if (const fs::path path = fs::path(folder) / "dfclient"; !folder.empty() && isProgram(path)) return path;
  }
  return std::nullopt;
}

LocalClient::LocalClient(const fs::path& program, const std::vector<std::string>& arguments,
                         const std::string& password, const std::string& log_file)
    : m_redirect(log_file) {
  std::vector<std::string> words{program.string()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<std::string> environment = environmentOfClient(password);

  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  for (int n = 0; n < 3; ++n) {
    if (m_redirect.original(n) >= 0) posix_spawn_file_actions_adddup2(&actions, m_redirect.original(n), n);
  }
  // The client must not inherit the game's sockets, because it would keep the port in use while it lives.
  posix_spawn_file_actions_addclosefrom_np(&actions, 3);
  const int problem = posix_spawn(&m_process, program.c_str(), &actions, nullptr, argvPointers(words).data(),
                                  argvPointers(environment).data());
  posix_spawn_file_actions_destroy(&actions);
  if (problem == 0) return;
  m_process = -1;
  throw std::system_error(problem, std::generic_category(), program.string() + " cannot be started");
}

LocalClient::~LocalClient() {
  if (hasEnded()) return;
  // glibc 2.36 declares pidfd_open() without extern "C".
  const int handle = static_cast<int>(syscall(SYS_pidfd_open, m_process, 0));
  pollfd ended{handle, POLLIN, 0};
  if (handle < 0 || poll(&ended, 1, kExitTimeoutMillis) <= 0) kill(m_process, SIGTERM);
  if (handle >= 0) close(handle);
  int status = 0;
  while (waitpid(m_process, &status, 0) < 0 && errno == EINTR) {
  }
}

void LocalClient::end() const {
  if (m_process > 0) kill(m_process, SIGTERM);
}

bool LocalClient::hasEnded() {
  if (m_process < 0) return true;
  int status = 0;
  const pid_t ended = waitpid(m_process, &status, WNOHANG);
  if (ended == 0 || (ended < 0 && errno == EINTR)) return false;
  // If the game waits for its own child processes, it may have taken the status.
  m_failed = ended > 0 && meansFailure(status);
  m_process = -1;
  return true;
}

}  // namespace naiad
