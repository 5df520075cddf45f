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
  return !isPlaying(session) && !(session.state() == Session::State::kGreeting && session.hasHello());
}

bool isConnected(const Session& session) {
  return isPlaying(session) && !session.isDetached();
}

}  // namespace

void sendServerLine(Session& session, const std::string& text) {
  wire::ServerMessage message;
  message.mutable_chat()->set_text(
      safeText(text, kMaxChatLength));  // without a player, the line is from the server
  session.sendReliable(message);
}

SessionTable::SessionTable(std::size_t max_sessions, Counters& counters,
                           std::function<void(Session&)> on_remove)
    : m_max_sessions(max_sessions), m_counters(counters), m_on_remove(std::move(on_remove)) {}

void SessionTable::add(std::unique_ptr<ReliableChannel> channel, Session::Events events,
                       Clock::time_point now) {
  ++m_counters.connections;
  const AddressPrefix prefix = AddressPrefix::ofEndpoint(channel->peerAddress()).value_or(AddressPrefix());
  if (!evictFor(prefix)) return;
  m_slots.push_back({std::make_unique<Session>(std::move(channel), m_counters, now), prefix});
  m_slots.back().session->setId(m_next_id++);
  m_slots.back().session->start(std::move(events));
}

// Connections without a hello count, too, or they would evade the limit. A client whose password is being
// checked has sent its hello, so it is never evicted.
bool SessionTable::evictFor(const AddressPrefix& newcomer) {
  if (m_slots.size() >= m_max_sessions) sweep();
  if (m_slots.size() < m_max_sessions) return true;
  ++m_counters.connections_rejected;
  const auto idle = evictionCandidate(newcomer);
  if (idle == m_slots.end()) return false;
  m_on_remove(*idle->session);
  m_slots.erase(idle);
  return true;
}

// Returns the idle session to evict: the oldest one, because real clients send a hello at once, but from the
// most crowded addresses, because honest sessions whose hello is on its way may be older than a flood's.
SessionTable::SessionSlots::iterator SessionTable::evictionCandidate(const AddressPrefix& newcomer) {
  std::map<AddressPrefix, int> networks{{newcomer.widest(), 1}};
  std::map<AddressPrefix, int> prefixes{{newcomer, 1}};
  for (const SessionSlot& slot : m_slots) {
    if (!isIdle(*slot.session)) continue;
    ++networks[slot.prefix.widest()];
    ++prefixes[slot.prefix];
  }
  auto found = m_slots.end();
  std::pair<int, int> most{0, 0};
  for (auto slot = m_slots.begin(); slot != m_slots.end(); ++slot) {
    if (!isIdle(*slot->session)) continue;
    const std::pair crowd{networks[slot->prefix.widest()], prefixes[slot->prefix]};
    if (crowd > most) std::tie(found, most) = std::tie(slot, crowd);
  }
  return found;
}

// Restored sessions whose players have not returned have no address, so they crowd none.
bool SessionTable::makePlace(const AddressPrefix& newcomer, std::size_t places, Clock::time_point now,
                             const std::function<bool(const Session&)>& counts) {
  std::vector<const SessionSlot*> taken;
  std::map<AddressPrefix, std::size_t> held;
  for (const SessionSlot& slot : m_slots) {
    if (!isPlaying(*slot.session) || (counts && !counts(*slot.session))) continue;
    taken.push_back(&slot);
    ++held[slot.prefix];
  }
  if (taken.size() != places || held.contains(newcomer)) return false;
  held.erase(AddressPrefix());
  std::erase_if(taken, [&](const SessionSlot* p_slot) {
    return 4 * held[p_slot->prefix] < places || p_slot->session->status().idle(now) < kIdleTime;
  });
  const auto longest = std::ranges::max_element(
      taken, {}, [now](const SessionSlot* p_slot) { return p_slot->session->status().idle(now); });
  if (longest == taken.end()) return false;
  ++m_counters.idle_kicks;
  (*longest)->session->sendGoodbye("Disconnected: no input for a minute, and the server needed your place.");
  return true;
}

void SessionTable::sweep() {
  std::erase_if(m_slots, [this](const SessionSlot& slot) {
    const bool gone = slot.session->state() == Session::State::kGone;
    if (gone) m_on_remove(*slot.session);
    return gone;
  });
}

Session& SessionTable::addDetached(Clock::time_point now) {
  m_slots.push_back({std::make_unique<Session>(nullptr, m_counters, now), AddressPrefix()});
  m_slots.back().session->setId(m_next_id++);
  return *m_slots.back().session;
}

Session* SessionTable::find(std::uint64_t id) const {
  const auto found = std::lower_bound(
      m_slots.begin(), m_slots.end(), id,
      [](const SessionSlot& slot, std::uint64_t wanted) { return slot.session->id() < wanted; });
  return found != m_slots.end() && found->session->id() == id ? found->session.get() : nullptr;
}

std::size_t SessionTable::playingCount() const {
  return static_cast<std::size_t>(std::count_if(
      m_slots.begin(), m_slots.end(), [](const SessionSlot& slot) { return isPlaying(*slot.session); }));
}

std::size_t SessionTable::connectedCount() const {
  return static_cast<std::size_t>(std::count_if(
      m_slots.begin(), m_slots.end(), [](const SessionSlot& slot) { return isConnected(*slot.session); }));
}

std::uint64_t SessionTable::skippedTicks(std::uint32_t player) const {
  const auto found = std::find_if(m_slots.begin(), m_slots.end(), [player](const SessionSlot& slot) {
    return slot.session->player() == player;
  });
  return found != m_slots.end() ? found->session->skippedTicks() : 0;
}

}  // namespace naiad
