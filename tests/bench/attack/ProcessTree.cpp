#include "ProcessTree.h"

#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

namespace bench::attack {

namespace {

struct Process {
  pid_t parent = 0;
  char state = '?';
  std::string name;
};

/// All that can be seen.
std::map<pid_t, Process> allProcesses() {
  std::map<pid_t, Process> all;
  std::error_code gone;
  for (const auto& entry : std::filesystem::directory_iterator("/proc", gone)) {
    const std::string number = entry.path().filename();
    if (!std::all_of(number.begin(), number.end(), [](char c) { return c >= '0' && c <= '9'; })) continue;
    std::ifstream file(entry.path() / "stat");
    std::string line;
    if (!std::getline(file, line)) continue;
    const std::size_t open = line.find('(');
    const std::size_t shut = line.rfind(')');
    if (open == std::string::npos || shut == std::string::npos) continue;
    Process process;
    process.name = line.substr(open + 1, shut - open - 1);
    std::istringstream words(line.substr(shut + 1));
    words >> process.state >> process.parent;
    all[std::stoi(number)] = process;
  }
  return all;
}

bool descends(const std::map<pid_t, Process>& all, pid_t process, pid_t from) {
  for (auto at = all.find(process); at != all.end(); at = all.find(at->second.parent)) {
    if (at->second.parent == from) return true;
  }
  return false;
}

}  // namespace

std::vector<pid_t> descendantsNamed(const std::string& name) {
  const std::map<pid_t, Process> all = allProcesses();
  std::vector<pid_t> found;
  for (const auto& [id, process] : all) {
    if (process.name == name && process.state != 'Z' && descends(all, id, getpid())) found.push_back(id);
  }
  return found;
}

}  // namespace bench::attack
