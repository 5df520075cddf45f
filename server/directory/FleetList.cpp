#include "server/directory/FleetList.h"

#include <algorithm>
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
  entry.sent = {0, entry.sent[0], entry.sent[1]};
  return is_new;
}

std::vector<std::string> FleetList::removeSilent(Time now) {
  std::vector<std::string> gone;
  for (auto at = m_servers.begin(); at != m_servers.end();) {
    if (now - at->second.heard < m_life) {
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

bool FleetList::isOfKind(const Entry& entry, const Wish& wish) {
  const Presence& there = entry.presence;
  return !there.asks_password && !there.host.empty() && !there.key.empty() && there.port >= kLeastFleetPort &&
         there.protocol == wish.protocol && there.id != wish.not_id &&
         (wish.game.empty() || there.game == wish.game);
}

bool FleetList::fits(const Entry& entry, const Wish& wish) {
  return isOfKind(entry, wish) && entry.presence.is_open && entry.taken() < entry.presence.max_players;
}

bool FleetList::isCalm(const Entry& entry) {
  return entry.taken() < entry.presence.max_players / 4 * 3;
}

bool FleetList::isBetter(const Entry& a, const Entry& b) {
  const auto free = [](const Entry& entry) { return entry.presence.max_players - entry.taken(); };
  if (isCalm(a) != isCalm(b)) return isCalm(a);
  return isCalm(a) ? a.taken() > b.taken() : free(a) > free(b);
}

const Presence* FleetList::choose(const Wish& wish) {
  Entry* p_best = nullptr;
  for (auto& [id, entry] : m_servers) {
    if (fits(entry, wish) && (p_best == nullptr || isBetter(entry, *p_best))) p_best = &entry;
  }
  if (p_best == nullptr) return nullptr;
  ++p_best->sent[0];
  return &p_best->presence;
}

const Presence* FleetList::roomiest(const Wish& wish) const {
  const auto free = [](const Entry& entry) { return entry.presence.max_players - entry.taken(); };
  const Entry* p_best = nullptr;
  for (const auto& [id, entry] : m_servers) {
    if (fits(entry, wish) && (p_best == nullptr || free(entry) > free(*p_best))) p_best = &entry;
  }
  return p_best != nullptr ? &p_best->presence : nullptr;
}

bool FleetList::plays(const Wish& wish) const {
  return std::any_of(m_servers.begin(), m_servers.end(),
                     [&wish](const auto& one) { return isOfKind(one.second, wish); });
}

std::vector<Presence> FleetList::crowded() const {
  std::vector<Presence> found;
  for (const auto& [id, entry] : m_servers) {
    if (!entry.presence.is_open || !isCalm(entry)) found.push_back(entry.presence);
  }
  return found;
}

std::vector<Presence> FleetList::servers() const {
  std::vector<Presence> all;
  all.reserve(m_servers.size());
  for (const auto& [id, entry] : m_servers) all.push_back(entry.presence);
  return all;
}

}  // namespace naiad
