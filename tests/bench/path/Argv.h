// A command in the form that exec() needs.
#pragma once

#include <string>
#include <vector>

namespace bench::path {

/// Returns pointers into `command`, followed by a null.
inline std::vector<char*> argvOf(const std::vector<std::string>& command) {
  std::vector<char*> argv;
  argv.reserve(command.size() + 1);
  for (const std::string& word : command) argv.push_back(const_cast<char*>(word.c_str()));
  argv.push_back(nullptr);
  return argv;
}

}  // namespace bench::path
