// Runs a program to its end.
#pragma once

#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

namespace naiad::test {

/// Returns the words as execv() takes them. They must outlive the result.
inline std::vector<char*> pointersTo(std::vector<std::string>& words) {
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  return pointers;
}

/// Runs a shell command. Returns its exit code and standard output.
inline std::pair<int, std::string> runProgram(const std::string& line) {
  FILE* p_pipe = popen(line.c_str(), "r");
  if (p_pipe == nullptr) return {-1, ""};
  std::string output;
  std::array<char, 4096> piece;
  for (std::size_t size = 0; (size = fread(piece.data(), 1, piece.size(), p_pipe)) > 0;)
    output.append(piece.data(), size);
  const int status = pclose(p_pipe);
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, output};
}

}  // namespace naiad::test
