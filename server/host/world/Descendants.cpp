#include "host/world/Descendants.h"

#include <dirent.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <chrono>
#include <climits>
#include <fstream>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "shared/net/base/SafeText.h"

namespace naiad {

namespace {

using Clock = std::chrono::steady_clock;

constexpr int kNapMillis = 2;
/// Time limit of killDescendants(), because a process that waits for a dead disk cannot be killed.
constexpr std::chrono::seconds kKillTimeout{20};
/// Limit of killOthers(), because players wait. A limit in time would be used up by a pause of the machine.
constexpr int kMaxSearches = 250;

/// Returns the parent of a process; 0 if it has none, or does not exist.
pid_t parentOf(pid_t process) {
  const std::string fields = statFieldsOf(process);
  pid_t parent = 0;
  if (fields.size() > 2) std::from_chars(fields.data() + 2, fields.data() + fields.size(), parent);
  return parent;
}

std::map<pid_t, pid_t> parents() {
  std::map<pid_t, pid_t> all;
  DIR* p_folder = opendir("/proc");
  if (p_folder == nullptr) return all;
  while (const dirent* p_entry = readdir(p_folder)) {
    if (const auto process = readNumber(p_entry->d_name, 1, INT_MAX))
      all.emplace(*process, parentOf(*process));
  }
  closedir(p_folder);
  return all;
}

}  // namespace

std::string statFieldsOf(pid_t process) {
  std::ifstream file("/proc/" + std::to_string(process) + "/stat");
  std::string line;
  std::getline(file, line);
  const std::size_t name_end = line.rfind(')');
  return name_end != std::string::npos && name_end + 2 < line.size() ? line.substr(name_end + 2) : "";
}

bool isDescendant(pid_t process) {
  constexpr int kMaxSteps = 64;  // entries that change while they are read may form a circle
  const pid_t self = getpid();
  for (int step = 0; step < kMaxSteps && process > 1; ++step) {
    process = parentOf(process);
    if (process == self) return true;
  }
  return false;
}

std::vector<Descendant> findDescendants() {
  const std::map<pid_t, pid_t> parent_of = parents();
  std::vector<Descendant> found;
  for (const auto& [process, parent] : parent_of) {
    std::size_t steps = 0;  // entries that changed while they were read may form a circle
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

std::vector<pid_t> findChildren() {
  std::vector<pid_t> found;
  const int file = open("/proc/thread-self/children", O_RDONLY | O_CLOEXEC);
  if (file < 0) return found;  // the kernel was built without this list
  std::string text;
  char piece[4096];
  for (ssize_t size = 0; (size = read(file, piece, sizeof piece)) > 0;)
    text.append(piece, static_cast<std::size_t>(size));
  close(file);
  pid_t child = 0;
  const char* p_end = text.data() + text.size();
  for (const char* p = text.data(); p < p_end; ++p) {
    const auto [p_read, error] = std::from_chars(p, p_end, child);
    if (error == std::errc()) found.push_back(child);
    p = p_read;
  }
  return found;
}

// Kills the group, too, because the child may have started processes in it.
void killChild(pid_t child) {
  kill(child, SIGKILL);
  kill(-child, SIGKILL);
}

int killDescendants(pid_t leader) {
  int status = SIGKILL;
  if (leader > 0) {
    kill(-leader, SIGKILL);  // the whole group at once, so that none of its processes can fork again
    kill(leader, SIGKILL);   // in case the leader has left its group
  }
  std::set<pid_t> ended;
  bool naps = false;
  for (const auto end = Clock::now() + kKillTimeout; Clock::now() < end;) {
    int how = 0;
    pid_t child = 0;
    while ((child = waitpid(-1, &how, WNOHANG)) > 0) {
      if (child == leader) status = how;
      ended.erase(child);
    }
    if (child < 0 && errno == ECHILD) break;
    bool news = false;
    for (const pid_t one : findChildren()) {
      if (!ended.insert(one).second) continue;
      killChild(one);
      news = true;
    }
    if (news) continue;  // search again at once: a process may have forked before it was killed
    poll(nullptr, 0, kNapMillis);
    if (!std::exchange(naps, true)) continue;  // search /proc only if processes are left after a pause
    for (const Descendant& one : findDescendants()) kill(one.process, SIGKILL);
  }
  return status;
}

bool killOthers(const std::set<pid_t>& kept) {
  for (int search = 0; search < kMaxSearches; ++search) {
    std::set<pid_t> others;
    for (const pid_t child : findChildren()) others.insert(child);
    for (const Descendant& one : findDescendants()) {
      if (kept.count(one.branch) == 0) others.insert(one.process);
    }
    for (const pid_t child : kept) others.erase(child);
    if (others.empty()) return true;
    for (const pid_t one : others) {
      kill(one, SIGKILL);
      waitpid(one, nullptr, WNOHANG);
    }
    poll(nullptr, 0, kNapMillis);
  }
  return false;
}

}  // namespace naiad
