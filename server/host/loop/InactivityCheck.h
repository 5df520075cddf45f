// Ends sessions of players who do nothing: no key, no click, no line of chat.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <functional>
#include <string>
#include <unordered_set>

#include "host/session/Counters.h"
#include "host/session/Session.h"
#include "shared/admin/TimeSpan.h"

namespace naiad {

/// Not thread-safe. Time is passed in.
class InactivityCheck {
 public:
  /// Players are warned so long before; of a shorter limit, at half of it.
  static constexpr std::chrono::seconds kWarning{10};

  /// Once a tick for each session that plays. `limit` 0: nobody is ended. One without a connection has its
  /// grace time instead.
  void check(Session& session, std::chrono::seconds limit, Counters& counters,
             const std::function<void(Session&, const std::string& line)>& tell) {
    if (limit.count() <= 0 || session.state() != Session::State::kPlaying || session.isDetached()) return;
    const auto idle = session.now() - session.standing().acted();
    const std::chrono::duration<double> warned_at =
        std::max<std::chrono::duration<double>>(limit - kWarning, limit / 2.0);
    if (idle < warned_at) {
      if (!m_warned.empty()) m_warned.erase(session.id());
    } else if (idle >= limit) {
      m_warned.erase(session.id());
      ++counters.inactive;
      session.goodbye("You did nothing for " + timeSpanText(limit) + ".");
    } else if (m_warned.insert(session.id()).second) {
      tell(session, "Press a key, or you leave the game in a moment.");
    }
  }
  /// The session is over.
  void forget(const Session& session) { m_warned.erase(session.id()); }

 private:
  std::unordered_set<std::uint64_t> m_warned;  ///< sessions
};

}  // namespace naiad
