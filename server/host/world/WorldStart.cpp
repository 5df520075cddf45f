#include "host/world/WorldStart.h"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <charconv>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <string_view>
#include <system_error>

#include "host/world/WordPointers.h"

namespace naiad {

namespace {

constexpr const char* kVariable = "NAIAD_WORLD_SOCKET";
constexpr int kSocket = STDERR_FILENO + 1;  ///< in the new process

std::string workingDirectory() {
  std::error_code error;
  return std::filesystem::current_path(error).string();
}

// For ever: a game's main() may go elsewhere.
const std::string& g_began_in = *new std::string(workingDirectory());

void require(int error, const char* what) {
  if (error != 0) throw std::system_error(error, std::generic_category(), what);
}

class Actions {
 public:
  explicit Actions(int socket) {
    require(posix_spawn_file_actions_init(&m_actions), "a new world");
    posix_spawn_file_actions_addchdir_np(&m_actions, g_began_in.c_str());
    posix_spawn_file_actions_addopen(&m_actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_adddup2(&m_actions, socket, kSocket);
    posix_spawn_file_actions_addclosefrom_np(&m_actions, kSocket + 1);
    require(posix_spawnattr_init(&m_attributes), "a new world");
    sigset_t none;
    sigemptyset(&none);
    posix_spawnattr_setsigmask(&m_attributes, &none);
    posix_spawnattr_setpgroup(&m_attributes, 0);
    posix_spawnattr_setflags(&m_attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETPGROUP);
  }
  ~Actions() {
    posix_spawn_file_actions_destroy(&m_actions);
    posix_spawnattr_destroy(&m_attributes);
  }
  Actions(const Actions&) = delete;
  Actions& operator=(const Actions&) = delete;

  const posix_spawn_file_actions_t* actions() const { return &m_actions; }
  const posix_spawnattr_t* attributes() const { return &m_attributes; }

 private:
  posix_spawn_file_actions_t m_actions;
  posix_spawnattr_t m_attributes;
};

std::vector<std::string> environment() {
  std::vector<std::string> entries;
  const std::string ours = std::string(kVariable) + "=";
  for (char** p = environ; *p != nullptr; ++p) {
    if (!std::string_view(*p).starts_with(ours)) entries.emplace_back(*p);
  }
  entries.push_back(ours + std::to_string(kSocket));
  return entries;
}

}  // namespace

StartedWorld startWorld(const std::string& program, const std::vector<std::string>& arguments) {
  int sockets[2];
  require(socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, sockets) == 0 ? 0 : errno, "a new world");
  std::cout.flush();
  StartedWorld started{-1, sockets[0]};
  int error = 0;
  try {
    const Actions actions(sockets[1]);
    std::vector<std::string> words = arguments;
    std::vector<std::string> entries = environment();
    error = posix_spawn(&started.process, program.c_str(), actions.actions(), actions.attributes(),
                        pointersTo(words).data(), pointersTo(entries).data());
  } catch (...) {
    close(sockets[0]);
    close(sockets[1]);
    throw;
  }
  close(sockets[1]);
  if (error != 0) close(sockets[0]);
  require(error, "a new world");
  return started;
}

StartedWorld startThisProgramAsWorld() {
  std::ifstream file("/proc/self/cmdline", std::ios::binary);
  const std::string all{std::istreambuf_iterator<char>(file), {}};
  std::vector<std::string> words;
  for (std::size_t begin = 0; begin < all.size(); begin += words.back().size() + 1) {
    words.emplace_back(all.data() + begin);
  }
  return startWorld("/proc/self/exe", words);
}

std::optional<int> takeWorldSocket() {
  const char* p_said = std::getenv(kVariable);
  if (p_said == nullptr) return std::nullopt;
  const std::string_view text(p_said);
  int socket = -1;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), socket);
  const bool good = error == std::errc() && end == text.data() + text.size() && socket > STDERR_FILENO;
  unsetenv(kVariable);  // programs that the game starts are no worlds
  if (!good || fcntl(socket, F_SETFD, FD_CLOEXEC) != 0) return std::nullopt;
  // If the host is killed while the game hangs, nothing else ends this process.
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  return socket;
}

}  // namespace naiad
