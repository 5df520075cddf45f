// Where a client keeps what another one needs to go on with its session: a file (SessionFile.h), or the
// memory of a browser's tab.
#pragma once

#include <string>

#include "client/trust/SavedSession.h"

namespace naiad {

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
