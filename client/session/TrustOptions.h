// Command-line options that dfclient and dfbot share: server, key, password. Also their exit codes.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "client/session/Connection.h"
#include "shared/net/stream/Fingerprint.h"
#include "shared/options/Options.h"

namespace naiad {

/// Exit codes of dfclient and dfbot. The numbers are documented in --help and used by scripts.
enum ExitCode {
  kExitLeft = 0,           ///< the player left, or the bot finished its task
  kExitUnreachable = 1,    ///< no connection to the server
  kExitUsage = 2,          ///< wrong command line or script; dfserver uses this code, too
  kExitRefused = 3,        ///< the server refused; its sentence is on stderr
  kExitEnded = 4,          ///< the server ended the game, or the search for a lost one failed
  kExitNoTerminal = 5,     ///< standard input or output is not a usable terminal
  kExitTruthMismatch = 6,  ///< the bot's pictures differ from the truth file, or could not be compared
};

/// Part of --help that both programs share: the exit codes.
inline constexpr const char* kExitCodeHelp =
    "Exit codes:\n"
    "  0  left                      3  refused by the server (the reason is on stderr)\n"
    "  1  cannot connect            4  the server ended the game, or was lost for good\n"
    "  2  wrong usage               5  no terminal (dfclient)\n"
    "  6  wrong cells, or nothing to compare (dfbot --truth-file)\n";

/// The server as given by the command line and the environment.
struct ServerChoice {
  std::string text = {};             ///< HOST[:PORT][/ROOM], link (JoinLink.h) or page address
  std::string visitors = {};         ///< path of a visitors' socket; empty: connect directly
  std::string visitor = {};          ///< ADDRESS:PORT of the remote player, given with `visitors`
  bool is_password_ambient = false;  ///< the password is from the environment, perhaps for another server
  std::optional<ShortKey> list_key = {};  ///< `text` was chosen from a list that names this key

  /// True if the password is from the environment and the server from a link, page or list. Then the password
  /// must not be sent, because strangers may have made these.
  bool dropsPassword() const;
};

Option serverOption(ServerChoice& server);
std::vector<Option> trustOptions(ServerChoice& server, ServerTrust& trust, SessionOptions& session);

/// Sets the results of the choice `server`: the address, the key that the server of a link or list must have,
/// the gateway, the room and the proxy. Clears a password that must not be sent (dropsPassword()). Call after
/// parseOptions(). Returns an error message, or "" on success. After an error, the caller must not connect.
std::string resolveServer(const ServerChoice& server, ServerAddress& address, ServerTrust& trust,
                          SessionOptions& session);

}  // namespace naiad
