// A dfclient in the terminal in which a game was started, so that running the game starts playing it.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace naiad {

/// Redirects the game's output to a file and empties its input while a client uses this process's terminal.
class OutputRedirect {
 public:
  /// Appends standard output, and standard error if it is a terminal, to this file, or to /dev/null if it is
  /// not a regular file that can be opened. Empties standard input. May throw std::system_error.
  explicit OutputRedirect(const std::string& path);
  /// Restores the standard descriptors.
  ~OutputRedirect();
  OutputRedirect(const OutputRedirect&) = delete;
  OutputRedirect& operator=(const OutputRedirect&) = delete;

  /// Returns the original standard input, output or error (`n`: 0, 1, 2), as a duplicate.
  int original(int n) const { return m_saved[n]; }

 private:
  int m_saved[3] = {-1, -1, -1};
};

class LocalClient {
 public:
  /// True if standard input and output are a terminal with this process in the foreground, and TERM is set.
  static bool hasTerminal();
  /// Returns the client program: the one named by NAIAD_CLIENT, otherwise the one installed or built with
  /// this library, otherwise one on the PATH. Nullopt if there is none.
  static std::optional<std::filesystem::path> findProgram();

  /// Starts the client, which takes the terminal; the game's output goes to `log_file`. The password is
  /// passed in the environment, which other users cannot see. Throws std::system_error.
  LocalClient(const std::filesystem::path& program, const std::vector<std::string>& arguments,
              const std::string& password, const std::string& log_file);
  /// Ends the client if it does not end by itself, and returns the terminal to the game.
  ~LocalClient();
  LocalClient(const LocalClient&) = delete;
  LocalClient& operator=(const LocalClient&) = delete;

  /// Asks the client to end.
  void end() const;
  /// True if the client has ended.
  bool hasEnded();
  /// True if it ended because it could not join or draw; false if its player left.
  bool hasFailed() const { return m_failed; }

 private:
  OutputRedirect m_redirect;
  pid_t m_process = -1;  ///< -1 after it has ended
  bool m_failed = false;
};

}  // namespace naiad
