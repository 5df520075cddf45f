// A command as exec() wants it.
#pragma once

#include <string>
#include <vector>

namespace bench::path {

/// Points into `command`, with a null at the end.
inline std::vector<char*> argvOf(const std::vector<std::string>& command) {
  std::vector<char*> argv;
  argv.reserve(command.size() + 1);
  for (const std::string& word : command) argv.push_back(const_cast<char*>(word.c_str()));
  argv.push_back(nullptr);
  return argv;
}

}  // namespace bench::path
