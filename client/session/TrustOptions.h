// The options that dfclient and dfbot share: the server, which key it must have, and the password.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "client/session/Connection.h"
#include "shared/net/stream/Fingerprint.h"
#include "shared/options/Options.h"

namespace naiad {

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
