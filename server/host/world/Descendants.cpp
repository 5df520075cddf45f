#include "host/world/Descendants.h"

#include <dirent.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstring>
#include <map>
#include <optional>
#include <string>

namespace naiad {

namespace {

constexpr int kRoundMillis = 2;
constexpr int kMaxRounds = 5'000;  ///< a process that waits for a dead disk cannot be ended

std::optional<pid_t> processOf(const char* name) {
  pid_t process = 0;
  const char* p_end = name + std::strlen(name);
  const auto [p_read, error] = std::from_chars(name, p_end, process);
  return error == std::errc() && p_read == p_end ? std::optional(process) : std::nullopt;
}

/// 0: it has none, or has ended.
pid_t parentOf(pid_t process) {
  const int file = open(("/proc/" + std::to_string(process) + "/stat").c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) return 0;
  char text[512];
  const ssize_t size = read(file, text, sizeof text - 1);
  close(file);
  if (size <= 0) return 0;
  text[size] = '\0';
  const char* p_state = std::strrchr(text, ')');  // "1 (any name) S 0 ..."
  if (p_state == nullptr || std::strlen(p_state) < 5) return 0;
  pid_t parent = 0;
  std::from_chars(p_state + 4, text + size, parent);
  return parent;
}

std::map<pid_t, pid_t> parents() {
  std::map<pid_t, pid_t> all;
  DIR* p_folder = opendir("/proc");
  if (p_folder == nullptr) return all;
  while (const dirent* p_entry = readdir(p_folder)) {
    if (const auto process = processOf(p_entry->d_name)) all.emplace(*process, parentOf(*process));
  }
  closedir(p_folder);
  return all;
}

}  // namespace

std::vector<Descendant> findDescendants() {
  const std::map<pid_t, pid_t> parent_of = parents();
  std::vector<Descendant> found;
  for (const auto& [process, parent] : parent_of) {
    std::size_t steps = 0;  // what was read while they changed may go in circles
    pid_t branch = process;
    pid_t above = parent;
    while (above > 1 && above != getpid() && ++steps < parent_of.size()) {
      branch = above;
      const auto next = parent_of.find(above);
      above = next != parent_of.end() ? next->second : 0;
    }
    if (above == getpid()) found.push_back({process, branch});
  }
  return found;
}

int endDescendants(pid_t leader) {
  int status = SIGKILL;
  kill(-leader, SIGKILL);  // all of the group at once: none of it can fork on
  kill(leader, SIGKILL);   // should it have left its group
  for (int round = 0; round < kMaxRounds; ++round) {
    int ended = 0;
    pid_t child = 0;
    while ((child = waitpid(-1, &ended, WNOHANG)) > 0) {
      if (child == leader) status = ended;
    }
    if (child < 0 && errno == ECHILD) break;
    poll(nullptr, 0, kRoundMillis);
    if (round == 0) continue;  // mostly it was the group alone
    for (const Descendant& one : findDescendants()) kill(one.process, SIGKILL);
  }
  return status;
}

}  // namespace naiad
