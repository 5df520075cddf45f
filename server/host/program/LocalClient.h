// A dfclient in the terminal in which a game was started, so that running the game is playing it.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace naiad {

/// While a client draws in this process's terminal, the game's output goes to a file, and its input is empty.
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

class LocalClient {
 public:
  /// Is there a terminal on standard input and output, whose foreground is ours?
  static bool hasTerminal();
  /// The program: what the environment names (NAIAD_CLIENT), else the one installed or built with this
  /// library, else one on the PATH. Nothing if there is none.
  static std::optional<std::filesystem::path> findProgram();

  /// Start it. It has the terminal from now on; what the game prints goes to `log_file`. The server's
  /// password goes by the environment, which other users do not see. Throws std::system_error.
  LocalClient(const std::filesystem::path& program, const std::vector<std::string>& arguments,
              const std::string& password, const std::string& log_file);
  /// Ends it, if it does not end by itself, and gives the terminal back to the game.
  ~LocalClient();
  LocalClient(const LocalClient&) = delete;
  LocalClient& operator=(const LocalClient&) = delete;

  /// Has it ended?
  bool hasEnded();
  /// Did it end because it could not join or draw? (Else its player has left.)
  bool hasFailed() const { return m_failed; }

 private:
  OutputRedirect m_redirect;
  pid_t m_process = -1;  ///< until it has ended
  bool m_failed = false;
};

}  // namespace naiad
