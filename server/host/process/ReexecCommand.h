// Restarts the server's program in this process.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace naiad {

/// The command that started this process. run() executes the program again in this process, as it is on disk
/// at that time, so the parent that waits for this process notices nothing.
class ReexecCommand {
 public:
  /// Call before a password is hidden in `argv`.
  ReexecCommand(int argc, const char* const* argv);
  /// Reads the command from /proc.
  static ReexecCommand ofProcess();

  /// Returns the program's path.
  const std::string& program() const { return m_program; }
  /// Returns the arguments after the program's name.
  std::vector<std::string> arguments() const;
  int argc() const { return static_cast<int>(m_arguments.size()); }
  /// Returns pointers to all words, then a null one. Valid as long as this.
  std::vector<const char*> argv() const;
  /// Executes the program again with this port, whatever port the command line gave. Close sockets and files
  /// before. Throws std::system_error if it fails.
  [[noreturn]] void run(std::uint16_t port) const;

 private:
  explicit ReexecCommand(std::vector<std::string> arguments);

  std::string m_program;  ///< path of the program
  std::vector<std::string> m_arguments;
};

}  // namespace naiad
