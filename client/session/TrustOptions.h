// What the command lines of dfclient and dfbot share: the server, which key it must have, the password, and
// how they end.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "client/session/Connection.h"
#include "shared/net/stream/Fingerprint.h"
#include "shared/options/Options.h"

namespace naiad {

/// How dfclient and dfbot end. The numbers are documented in --help and used by scripts.
enum ExitCode {
  kExitLeft = 0,         ///< the player left, or the bot did what it should
  kExitUnreachable = 1,  ///< no connection to the server
  kExitUsage = 2,        ///< wrong command line or script, as of dfserver
  kExitRefused = 3,      ///< the server refused; its sentence is on stderr
  kExitEnded = 4,        ///< the server ended the game, or was lost for good
  kExitNoTerminal = 5,   ///< standard input or output is no terminal that can be drawn on
  kExitUnproven = 6,     ///< what the bot saw is not what the truth file says, or could not be compared
};

/// The part of --help that both programs share.
inline constexpr const char* kExitCodeHelp =
    "Exit codes:\n"
    "  0  left                      3  refused by the server (its sentence is on stderr)\n"
    "  1  cannot connect            4  the server ended the game, or was lost for good\n"
    "  2  wrong usage               5  no terminal (dfclient)\n"
    "  6  wrong cells, or nothing to compare (dfbot --truth)\n";

/// What the command line and the environment say about the server.
struct ServerChoice {
  std::string text = {};                  ///< HOST[:PORT], or a link (JoinLink.h)
  std::string visitors = {};              ///< path of a visitors' socket; empty: straight to the server
  std::string visitor = {};               ///< with it, the address of the remote player: ADDRESS:PORT
  bool is_password_ambient = false;       ///< the password is from the environment, not given for this server
  std::optional<ShortKey> list_key = {};  ///< `text` was chosen from a list, which says that it has this key

  /// Links, pages and lists do not get the password from the environment: strangers make them.
  bool dropsPassword() const;
};

/// The required argument.
Option serverOption(ServerChoice& server);
std::vector<Option> trustOptions(ServerChoice& server, ServerTrust& trust, SessionOptions& session);

/// Call after parseOptions(): find the address in `server`, and with a link the key that the server must
/// have. Returns a sentence about what is wrong, else nothing; then nothing must be connected to.
std::string resolveServer(const ServerChoice& server, ServerAddress& address, ServerTrust& trust,
                          SessionOptions& session);

}  // namespace naiad
