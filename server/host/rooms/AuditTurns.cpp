#include "host/rooms/AuditTurns.h"

#include "host/rooms/Room.h"

namespace naiad {

void AuditTurns::noteJoin(Session& session, std::uint32_t tick) {
  if (m_ticks_per_second == 0) return;
  if (m_p_session == nullptr || tick - m_since >= kPeriod * m_ticks_per_second) give(session, tick);
}

void AuditTurns::noteRound(const Room& room, std::uint32_t tick) {
  if (m_ticks_per_second == 0) return;
  if (m_p_session != nullptr && !room.has(*m_p_session)) return;  // another room's
  Session* p_first = nullptr;
  Session* p_next = nullptr;
  room.forEachPlaying([&](Session& session) {
    if (p_first == nullptr) p_first = &session;
    if (p_next == nullptr && session.player() > m_last) p_next = &session;
  });
  if (p_next == nullptr) p_next = p_first;
  if (p_next != nullptr) give(*p_next, tick);
}

void AuditTurns::forget(const Session& session) {
  if (m_p_session == &session) m_p_session = nullptr;
}

// One second in so many, counted from the beginning of the turn, so that a player who stays briefly is
// audited, too.
std::uint32_t AuditTurns::pictured(std::uint32_t tick) const {
  if (m_p_session == nullptr) return 0;
  return (tick - m_since) / m_ticks_per_second % kPeriod == 0 ? m_p_session->player() : 0;
}

void AuditTurns::give(Session& session, std::uint32_t tick) {
  if (m_p_session != nullptr) m_p_session->setAudit(false);
  session.setAudit(true);
  m_p_session = &session;
  m_since = tick;
  m_last = session.player();
}

}  // namespace naiad
