// Where a client keeps what another one needs to go on with its session: a file (SessionFile.h), or the
// memory of a browser's tab.
#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "shared/net/stream/Fingerprint.h"

namespace naiad {

/// What of a session outlives the client's process, as text in a file: its server, name and resume token.
struct SavedSession {
  using Time = std::chrono::system_clock::time_point;

  std::string server;  ///< "host:port", ServerAddress::canonicalText() of what the player named
  Fingerprint key;     ///< of the server that gave the token, which no other is sent
  std::string name;    ///< the wanted one
  std::string token;   ///< 1 to 64 bytes
  std::chrono::milliseconds grace{0};  ///< how long the server waits for a stream
  Time alive{};                        ///< when the session was last alive, to a millisecond

  /// May the session still be there?
  bool isWithinGrace(Time now) const { return now - alive <= grace; }
};

/// Bytes of each such text. Always the same, so that one write replaces another.
inline constexpr std::size_t kSavedSessionSize = 1024;

/// The text; nothing if something in it is too long or does not fit a line.
std::optional<std::string> writeSavedSession(const SavedSession& session);
/// Nothing if it is not such a text, to the last byte.
std::optional<SavedSession> readSavedSession(std::string_view text);

class TokenStore {
 public:
  using Time = SavedSession::Time;

  virtual ~TokenStore() = default;

  /// The token of the session that was left, for the server with this key; empty if there is none.
  virtual std::string tokenFor(const Fingerprint& key) const = 0;
  /// The session's token is another one now. `session.server` and `alive` are filled in.
  virtual void save(SavedSession session, Time now) = 0;
  /// The session is alive. Call about once a second.
  virtual void refresh(Time now) = 0;
  /// The session is over.
  virtual void remove() = 0;
};

}  // namespace naiad
