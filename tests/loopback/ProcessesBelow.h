// Which processes a server has started.
#pragma once

#include <sys/types.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace naiad::test {

/// The parent and the name of a process; nothing if there is none.
inline std::optional<std::pair<pid_t, std::string>> factsOf(const std::string& process) {
  std::ifstream file("/proc/" + process + "/stat");
  std::string line;
  if (!std::getline(file, line)) return std::nullopt;
  const std::size_t name = line.find('(');
  const std::size_t end = line.rfind(')');
  if (name == std::string::npos || end == std::string::npos) return std::nullopt;
  return std::pair(static_cast<pid_t>(std::atoi(line.c_str() + end + 4)),
                   line.substr(name + 1, end - name - 1));
}

/// The processes below the server's that have this name.
inline std::vector<pid_t> processesOf(pid_t server, const std::string& name) {
  std::vector<pid_t> found;
  for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
    const std::string process = entry.path().filename().string();
    const auto facts = factsOf(process);
    if (!facts || facts->second != name) continue;
    for (auto above = facts; above && above->first > 1; above = factsOf(std::to_string(above->first))) {
      if (above->first == server) found.push_back(std::atoi(process.c_str()));
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace naiad::test
