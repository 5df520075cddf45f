// Looks up processes in /proc.
#pragma once

#include <sys/types.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/WaitUntil.h"

namespace naiad::test {

struct ProcessFacts {
  std::string name;
  char state;  ///< like in /proc; 'Z': a zombie, ended but not yet waited for
  pid_t parent;
};

/// Returns facts about a process; nullopt if it does not exist.
inline std::optional<ProcessFacts> factsOf(pid_t process) {
  // Reads the file at once, because an iterator of its stream throws if the process ends before it is read.
  std::ostringstream stat;
  stat << std::ifstream("/proc/" + std::to_string(process) + "/stat").rdbuf();
  const std::string text = stat.str();
  const std::size_t begin = text.find('(');
  const std::size_t end = text.rfind(')');
  if (begin == std::string::npos || end + 4 >= text.size()) return std::nullopt;
  return ProcessFacts{text.substr(begin + 1, end - begin - 1), text[end + 2],
                      std::atoi(text.c_str() + end + 4)};
}

/// Returns the state of a process; 'X' if it does not exist.
inline char stateOf(pid_t process) {
  const auto facts = factsOf(process);
  return facts ? facts->state : 'X';
}

/// Waits until a process does not exist, for at most a minute.
inline bool isGone(pid_t process) {
  return waitUntil([process] { return stateOf(process) == 'X'; });
}

/// Returns the descendants of `top` with this name in ascending order. An empty name matches all.
inline std::vector<pid_t> processesBelow(pid_t top, const std::string& name = "") {
  std::vector<pid_t> found;
  for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
    const pid_t process = std::atoi(entry.path().filename().c_str());
    const auto facts = factsOf(process);
    if (!facts || (!name.empty() && facts->name != name)) continue;
    for (auto above = facts; above && above->parent > 1; above = factsOf(above->parent))
      if (above->parent == top) found.push_back(process);
  }
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace naiad::test
