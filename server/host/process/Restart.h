// A server that begins again in its own place.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace naiad {

/// How this process was started. The same process runs the program again, as it is on the disk by then: who
/// has started it, and waits for it, notices nothing.
class StartCommand {
 public:
  /// Before a password is hidden in `argv`.
  StartCommand(int argc, const char* const* argv);
  /// The same, read from the process.
  static StartCommand ofProcess();

  /// Its path.
  const std::string& program() const { return m_program; }
  /// Behind the program's name.
  std::vector<std::string> arguments() const;
  int argc() const { return static_cast<int>(m_arguments.size()); }
  /// Ends with null; valid as long as this.
  std::vector<const char*> argv() const;
  /// Run the program again, with --port `port` where another one was asked for, or any. Close what is open
  /// first. Throws std::system_error if that cannot be.
  [[noreturn]] void run(std::uint16_t port) const;

 private:
  explicit StartCommand(std::vector<std::string> arguments);

  std::string m_program;  ///< path
  std::vector<std::string> m_arguments;
};

}  // namespace naiad
