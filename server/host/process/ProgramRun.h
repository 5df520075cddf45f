// Another program, run beside the game to its end: what it printed, and how it ended.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstddef>
#include <mutex>
#include <string>
#include <vector>

namespace naiad {

/// How a program ended.
struct ProgramEnd {
  /// The code of a program that cannot be started, as a shell has it.
  static constexpr int kNotStarted = 127;

  int code = kNotStarted;  ///< its exit code, if no signal ended it
  int signal = 0;          ///< that ended it; 0: none
  bool is_late = false;    ///< it was ended because its time was over
  std::string printed;     ///< on its standard output and error, the beginning of it
};

class ProgramRun {
 public:
  /// Bytes of what it prints that are kept.
  static constexpr std::size_t kMaxPrinted = std::size_t{64} << 10;

  /// Run the program at `path` with these arguments, without input, and wait for its end. When `limit` is
  /// over it is killed. It gets the environment of this process and none of its other files. One at a time.
  ProgramEnd run(const std::string& path, const std::vector<std::string>& arguments,
                 std::chrono::milliseconds limit);
  /// Kill the one that runs, and start no other. From any thread.
  void cancel();

 private:
  pid_t start(const std::string& path, const std::vector<std::string>& arguments, int output);

  std::mutex m_mutex;
  pid_t m_process = 0;  ///< 0: none runs
  bool m_is_cancelled = false;
};

}  // namespace naiad
