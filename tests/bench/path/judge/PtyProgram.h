// A program at a terminal of 80×24.
#pragma once

#include <sys/types.h>

#include <string>
#include <string_view>
#include <vector>

#include "../Monotonic.h"

namespace bench::path {

class PtyProgram {
 public:
  /// Starts it, with TERM=xterm-256color. Throws std::runtime_error.
  explicit PtyProgram(const std::vector<std::string>& command);
  /// Hangs up, and ends it if that does not.
  ~PtyProgram();
  PtyProgram(const PtyProgram&) = delete;
  PtyProgram& operator=(const PtyProgram&) = delete;

  /// What it wrote, as soon as it wrote something; empty at the deadline, and when it has ended.
  std::string_view read(Nanoseconds deadline);
  bool hasEnded() const { return m_ended; }
  /// Type these bytes.
  void write(std::string_view bytes) const;

 private:
  int m_terminal = -1;
  pid_t m_pid = -1;
  bool m_ended = false;
  std::vector<char> m_buffer;
};

}  // namespace bench::path
