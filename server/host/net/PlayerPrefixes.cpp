#include "host/net/PlayerPrefixes.h"

namespace naiad {

void PlayerPrefixes::note(std::uint64_t session, const AddressPrefix& prefix) {
  const std::lock_guard lock(m_mutex);
  const auto [found, joined] = m_sessions.try_emplace(session, Places{prefix, prefix});
  Places& places = found->second;
  if (!joined && places.present == prefix) return;
  if (!joined && places.present != places.joined) leave(places.present);
  places.present = prefix;
  if (joined || places.present != places.joined) ++m_counts[prefix];
}

void PlayerPrefixes::forget(std::uint64_t session) {
  const std::lock_guard lock(m_mutex);
  const auto ended = m_sessions.extract(session);
  if (ended.empty()) return;
  const Places& places = ended.mapped();
  if (places.present != places.joined) leave(places.present);
  leave(places.joined);
}

void PlayerPrefixes::leave(const AddressPrefix& prefix) {
  const auto found = m_counts.find(prefix);
  if (--found->second == 0) m_counts.erase(found);
}

std::size_t PlayerPrefixes::count(const AddressPrefix& prefix) const {
  const std::lock_guard lock(m_mutex);
  const auto found = m_counts.find(prefix);
  return found != m_counts.end() ? found->second : 0;
}

}  // namespace naiad
