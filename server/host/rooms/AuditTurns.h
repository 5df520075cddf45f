// Whose pictures are audited (PictureAudit.h), and when: one player at a time, one second in ten.
//
// An audit begins with a world that is sent from the beginning, so the turn goes to a player who joins once
// the one before had ten seconds, and to the next one by id when a round begins.
#pragma once

#include <cstdint>

#include "host/session/Session.h"

namespace naiad {

class Room;

/// Thread: the host's.
class AuditTurns {
 public:
  /// Ticks are compared in one second of so many.
  static constexpr std::uint32_t kPeriod = 10;

  /// Begin to audit. Before that nothing happens here.
  void start(std::uint32_t ticks_per_second) { m_ticks_per_second = ticks_per_second; }
  /// The session was welcomed, and has been sent nothing yet.
  void noteJoin(Session& session, std::uint32_t tick);
  /// All players of the room are about to be sent another world.
  void noteRound(const Room& room, std::uint32_t tick);
  /// The session is about to be destroyed.
  void forget(const Session& session);
  /// The player whose picture is wanted in this tick of the host; 0: none.
  std::uint32_t pictured(std::uint32_t tick) const;

 private:
  void give(Session& session, std::uint32_t tick);

  std::uint32_t m_ticks_per_second = 0;  ///< 0: there is no audit
  Session* m_p_session = nullptr;        ///< whose turn it is
  std::uint32_t m_since = 0;             ///< in this tick its turn began
  std::uint32_t m_last = 0;              ///< the player whose turn it was last
};

}  // namespace naiad
