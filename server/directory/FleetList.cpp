#include "server/directory/FleetList.h"

#include <utility>

#include "shared/fleet/ServerId.h"

namespace naiad {

bool FleetList::put(const std::string& subject, std::string_view payload, Time now) {
  auto presence = Presence::parse(payload);
  if (!presence) {
    ++m_counters.unreadable;
    return false;
  }
  if (presenceSubject(presence->id) != subject) {
    ++m_counters.foreign;
    return false;
  }
  const bool is_new = m_servers.count(presence->id) == 0;
  if (is_new && m_servers.size() >= kMaxServers) {
    ++m_counters.crowded;
    return false;
  }
  ++m_counters.heard;
  Entry& entry = m_servers[presence->id];
  entry.presence = *std::move(presence);
  entry.heard = now;
  entry.sent_before = std::exchange(entry.sent, 0);
  return is_new;
}

std::vector<std::string> FleetList::removeSilent(Time now) {
  std::vector<std::string> gone;
  for (auto at = m_servers.begin(); at != m_servers.end();) {
    if (now - at->second.heard < kLife) {
      ++at;
      continue;
    }
    gone.push_back(at->first);
    at = m_servers.erase(at);
  }
  m_counters.expired += gone.size();
  return gone;
}

void FleetList::forgiveSilence(Time now) {
  for (auto& [id, entry] : m_servers) entry.heard = now;
}

bool FleetList::fits(const Entry& entry, const Wish& wish) {
  const Presence& there = entry.presence;
  return there.is_open && !there.asks_password && !there.host.empty() && !there.key.empty() &&
         there.port >= kLeastFleetPort && there.protocol == wish.protocol && there.id != wish.not_id &&
         (wish.game.empty() || there.game == wish.game) && entry.taken() < there.max_players;
}

bool FleetList::isBetter(const Entry& a, const Entry& b) {
  const auto is_calm = [](const Entry& entry) { return entry.taken() < entry.presence.max_players / 4 * 3; };
  const auto free = [](const Entry& entry) { return entry.presence.max_players - entry.taken(); };
  if (is_calm(a) != is_calm(b)) return is_calm(a);
  return is_calm(a) ? a.taken() > b.taken() : free(a) > free(b);
}

const Presence* FleetList::choose(const Wish& wish) {
  Entry* p_best = nullptr;
  for (auto& [id, entry] : m_servers) {
    if (fits(entry, wish) && (p_best == nullptr || isBetter(entry, *p_best))) p_best = &entry;
  }
  if (p_best == nullptr) return nullptr;
  ++p_best->sent;
  return &p_best->presence;
}

std::vector<Presence> FleetList::servers() const {
  std::vector<Presence> all;
  all.reserve(m_servers.size());
  for (const auto& [id, entry] : m_servers) all.push_back(entry.presence);
  return all;
}

}  // namespace naiad
