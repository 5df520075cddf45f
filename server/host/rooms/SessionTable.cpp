#include "host/rooms/SessionTable.h"

#include <algorithm>
#include <map>
#include <tuple>
#include <utility>

#include "naiad.pb.h"
#include "shared/net/base/Limits.h"
#include "shared/net/base/SafeText.h"

namespace naiad {

namespace {

bool isPlaying(const Session& session) {
  return session.state() == Session::State::kPlaying;
}

/// True if the session neither plays nor waits for an answer to its hello.
bool isIdle(const Session& session) {
  return !isPlaying(session) && !(session.state() == Session::State::kGreeting && session.isGreeted());
}

bool isConnected(const Session& session) {
  return isPlaying(session) && !session.isDetached();
}

}  // namespace

void sendServerLine(Session& session, const std::string& text) {
  wire::ServerMessage message;
  message.mutable_chat()->set_text(safeText(text, kMaxChatLength));  // no player: a line from the server
  session.sendKept(message);
}

SessionTable::SessionTable(std::size_t max_sessions, Counters& counters,
                           std::function<void(Session&)> on_remove)
    : m_max_sessions(max_sessions), m_counters(counters), m_on_remove(std::move(on_remove)) {}

void SessionTable::add(std::unique_ptr<ReliableChannel> channel, Session::Events events,
                       Clock::time_point now) {
  ++m_counters.connections;
  const AddressPrefix prefix = AddressPrefix::ofEndpoint(channel->peerAddress()).value_or(AddressPrefix());
  if (!makeRoom(prefix)) return;
  m_places.push_back({std::make_unique<Session>(std::move(channel), m_counters, now), prefix});
  m_places.back().session->setId(m_next_id++);
  m_places.back().session->start(std::move(events));
}

// Connections without a hello count, too, or they would evade the limit. A client whose password is being
// checked has sent its hello, so it is never evicted.
bool SessionTable::makeRoom(const AddressPrefix& newcomer) {
  if (m_places.size() >= m_max_sessions) sweep();
  if (m_places.size() < m_max_sessions) return true;
  ++m_counters.turned_away;
  const auto idle = mostCrowding(newcomer);
  if (idle == m_places.end()) return false;
  m_on_remove(*idle->session);
  m_places.erase(idle);
  return true;
}

// Returns the idle session to evict: the oldest one, because real clients send a hello at once, but from the
// most crowded addresses, because honest sessions whose hello is on its way may be older than a flood's.
SessionTable::Places::iterator SessionTable::mostCrowding(const AddressPrefix& newcomer) {
  std::map<AddressPrefix, int> networks{{newcomer.widest(), 1}};
  std::map<AddressPrefix, int> prefixes{{newcomer, 1}};
  for (const Place& place : m_places) {
    if (!isIdle(*place.session)) continue;
    ++networks[place.prefix.widest()];
    ++prefixes[place.prefix];
  }
  auto found = m_places.end();
  std::pair<int, int> most{0, 0};
  for (auto place = m_places.begin(); place != m_places.end(); ++place) {
    if (!isIdle(*place->session)) continue;
    const std::pair crowd{networks[place->prefix.widest()], prefixes[place->prefix]};
    if (crowd > most) std::tie(found, most) = std::tie(place, crowd);
  }
  return found;
}

void SessionTable::sweep() {
  std::erase_if(m_places, [this](const Place& place) {
    const bool gone = place.session->state() == Session::State::kGone;
    if (gone) m_on_remove(*place.session);
    return gone;
  });
}

Session& SessionTable::addDetached(Clock::time_point now) {
  m_places.push_back({std::make_unique<Session>(nullptr, m_counters, now), AddressPrefix()});
  m_places.back().session->setId(m_next_id++);
  return *m_places.back().session;
}

Session* SessionTable::find(std::uint64_t id) const {
  const auto found =
      std::lower_bound(m_places.begin(), m_places.end(), id,
                       [](const Place& place, std::uint64_t wanted) { return place.session->id() < wanted; });
  return found != m_places.end() && found->session->id() == id ? found->session.get() : nullptr;
}

std::size_t SessionTable::playing() const {
  return static_cast<std::size_t>(std::count_if(
      m_places.begin(), m_places.end(), [](const Place& place) { return isPlaying(*place.session); }));
}

std::size_t SessionTable::connected() const {
  return static_cast<std::size_t>(std::count_if(
      m_places.begin(), m_places.end(), [](const Place& place) { return isConnected(*place.session); }));
}

std::uint64_t SessionTable::skippedTicks(std::uint32_t player) const {
  const auto found = std::find_if(m_places.begin(), m_places.end(),
                                  [player](const Place& place) { return place.session->player() == player; });
  return found != m_places.end() ? found->session->skippedTicks() : 0;
}

}  // namespace naiad
