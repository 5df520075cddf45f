// Interface of the store for a session's token, with which a later client process can resume the session: a
// file (SessionFile.h), or the storage of a browser tab.
#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "shared/net/stream/Fingerprint.h"

namespace naiad {

/// Data of a session that outlives the client's process, stored as text: its server, name and resume token.
struct SavedSession {
  using Time = std::chrono::system_clock::time_point;

  std::string server;  ///< "host:port": ServerAddress::canonicalText() of the address that the player typed
  Fingerprint key;     ///< key of the server that gave the token; the token is sent to no other server
  std::string name;    ///< the requested name
  std::string token;   ///< 1 to 64 bytes
  std::chrono::milliseconds grace{0};  ///< how long the server keeps a session without a stream
  Time alive{};                        ///< time when the session was last alive, in whole milliseconds

  /// True if the session may still exist.
  bool isWithinGrace(Time now) const { return now - alive <= grace; }
};

/// Bytes of a stored session. The size is constant, so that one write replaces another.
inline constexpr std::size_t kSavedSessionSize = 1024;

/// Returns the session as text; nullopt if it is too long, or if readSavedSession() would not accept it, for
/// example because a value contains a line end.
std::optional<std::string> writeSavedSession(const SavedSession& session);
/// Parses the text of writeSavedSession(). Nullopt if any byte is not as expected.
std::optional<SavedSession> readSavedSession(std::string_view text);

class TokenStore {
 public:
  using Time = SavedSession::Time;

  virtual ~TokenStore() = default;

  /// Returns the token of an earlier session with the server that has this key; empty without a session.
  virtual std::string tokenFor(const Fingerprint& key) const = 0;
  /// Stores a new token; an empty one removes the stored session. Sets `session.server` and `alive` itself.
  virtual void save(SavedSession session, Time now) = 0;
  /// Records that the session is alive. Call about once a second or more often.
  virtual void refresh(Time now) = 0;
  /// Removes the stored session, because it is over.
  virtual void remove() = 0;
};

}  // namespace naiad
