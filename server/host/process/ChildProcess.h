// Runs another program to its end, and collects its output.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstddef>
#include <mutex>
#include <string>
#include <vector>

namespace naiad {

/// The end of a program.
struct ChildExit {
  /// Code of a program that cannot be started, as in a shell.
  static constexpr int kNotStarted = 127;

  int code = kNotStarted;   ///< exit code, if no signal ended it
  int signal = 0;           ///< signal that ended it; 0: none
  bool timed_out = false;   ///< true if it was killed because its time was over
  std::string output_text;  ///< beginning of its standard output and error
};

class ChildProcess {
 public:
  /// Maximum bytes of its output in ChildExit::output_text; further ones are dropped.
  static constexpr std::size_t kMaxOutput = std::size_t{64} << 10;

  /// Runs one program, at `path` with these arguments, without input, and waits for its end. Kills it after
  /// `limit`. It gets the environment of this process and none of its other descriptors.
  ChildExit run(const std::string& path, const std::vector<std::string>& arguments,
                std::chrono::milliseconds limit);
  /// Kills the program that runs, and prevents further ones. Any thread.
  void cancel();

 private:
  pid_t start(const std::string& path, const std::vector<std::string>& arguments, int output);

  std::mutex m_mutex;
  pid_t m_process = 0;  ///< 0: none runs
  bool m_is_cancelled = false;
};

}  // namespace naiad
