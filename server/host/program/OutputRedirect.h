// While a client draws in this process's terminal, the game's output goes to a file, and its input is empty.
#pragma once

#include <string>

namespace naiad {

class OutputRedirect {
 public:
  /// Append standard output, and standard error if that is a terminal, to this file; where it cannot be
  /// opened, to nowhere. Standard input is empty from now on. Throws std::system_error without file
  /// descriptors to spare.
  explicit OutputRedirect(const std::string& path);
  /// As before.
  ~OutputRedirect();
  OutputRedirect(const OutputRedirect&) = delete;
  OutputRedirect& operator=(const OutputRedirect&) = delete;

  /// The standard descriptor `n` (0, 1, 2) as it was.
  int original(int n) const { return m_saved[n]; }

 private:
  int m_saved[3] = {-1, -1, -1};
};

}  // namespace naiad
