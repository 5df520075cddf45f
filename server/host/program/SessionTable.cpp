#include "host/program/SessionTable.h"

#include <algorithm>
#include <utility>

namespace naiad {

namespace {

bool isPlaying(const std::unique_ptr<Session>& session) {
  return session->state() == Session::State::kPlaying;
}

/// It neither plays nor waits for an answer to its hello.
bool isIdle(const std::unique_ptr<Session>& session) {
  return !isPlaying(session) && !(session->state() == Session::State::kGreeting && session->isGreeted());
}

bool isConnected(const std::unique_ptr<Session>& session) {
  return isPlaying(session) && !session->isDetached();
}

}  // namespace

SessionTable::SessionTable(std::size_t max_sessions, Counters& counters,
                           std::function<void(Session&)> on_remove)
    : m_max_sessions(max_sessions), m_counters(counters), m_on_remove(std::move(on_remove)) {}

void SessionTable::add(std::unique_ptr<ReliableChannel> channel, Session::Events events,
                       Clock::time_point now) {
  ++m_counters.connections;
  if (!makeRoom()) return;
  m_sessions.push_back(std::make_unique<Session>(std::move(channel), m_counters, now));
  m_sessions.back()->setId(m_next_id++);
  m_sessions.back()->start(std::move(events));
}

// Connections that have not said hello count, too, or they would evade the limit. The oldest of them
// goes, since a player says hello at once: a crowd of silent connections cannot lock players out. A client
// whose password is being compared has said hello, and stays.
bool SessionTable::makeRoom() {
  if (m_sessions.size() >= m_max_sessions) sweep();
  if (m_sessions.size() < m_max_sessions) return true;
  ++m_counters.turned_away;
  const auto idle = std::find_if(m_sessions.begin(), m_sessions.end(), isIdle);
  if (idle == m_sessions.end()) return false;
  m_on_remove(**idle);
  m_sessions.erase(idle);
  return true;
}

void SessionTable::sweep() {
  std::erase_if(m_sessions, [this](const auto& session) {
    const bool gone = session->state() == Session::State::kGone;
    if (gone) m_on_remove(*session);
    return gone;
  });
}

Session* SessionTable::find(std::uint64_t id) const {
  const auto found =
      std::lower_bound(m_sessions.begin(), m_sessions.end(), id,
                       [](const auto& session, std::uint64_t wanted) { return session->id() < wanted; });
  return found != m_sessions.end() && (*found)->id() == id ? found->get() : nullptr;
}

std::size_t SessionTable::playing() const {
  return static_cast<std::size_t>(std::count_if(m_sessions.begin(), m_sessions.end(), isPlaying));
}

std::size_t SessionTable::connected() const {
  return static_cast<std::size_t>(std::count_if(m_sessions.begin(), m_sessions.end(), isConnected));
}

std::uint64_t SessionTable::skippedTicks(std::uint32_t player) const {
  const auto found = std::find_if(m_sessions.begin(), m_sessions.end(),
                                  [player](const auto& session) { return session->player() == player; });
  return found != m_sessions.end() ? (*found)->skippedTicks() : 0;
}

}  // namespace naiad
