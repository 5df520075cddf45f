// A dfclient in the terminal in which a game was started, so that running the game is playing it.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "host/program/OutputRedirect.h"

namespace naiad {

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
