#include "engine/world/Interests.h"

#include <algorithm>
#include <cassert>

#include "engine/world/ObjectProfile.h"
#include "engine/world/WorldStore.h"

namespace df {

int Interests::add(ObjectKey key, ObjectProfile& profile, const std::string& type) {
  if (!m_store.has(key.slot, WorldStore::kInWorld)) return -1;
  const auto [it, is_new] = m_numbers.try_emplace(type, static_cast<std::uint32_t>(m_tables.size()));
  if (is_new) m_tables.emplace_back();
  auto& mine = profile.interests;
  if (std::find(mine.begin(), mine.end(), it->second) != mine.end()) return 0;
  mine.push_back(it->second);
  Table& table = m_tables[it->second];
  compact(table);
  table.entries.push_back(key);
  return 0;
}

int Interests::remove(ObjectKey key, ObjectProfile& profile, const std::string& type) {
  const auto it = m_numbers.find(type);
  if (it == m_numbers.end() || std::erase(profile.interests, it->second) == 0) return -1;
  Table& table = m_tables[it->second];
  const auto entry = std::find(table.entries.begin(), table.entries.end(), key);
  assert(entry != table.entries.end());  // the Object lists only types for which it has an entry
  *entry = ObjectKey{};
  ++table.gone;
  compact(table);
  return 0;
}

// Leaves the entries in the tables: the Object's generation ends, so their keys find no Object.
void Interests::removeAll(ObjectProfile& profile) {
  for (std::uint32_t number : profile.interests) ++m_tables[number].gone;
  profile.interests.clear();
}

void Interests::compact(Table& table) {
  if (table.walks > 0 || table.gone < 16 || table.gone * 2 < table.entries.size()) return;
  std::erase_if(table.entries, [this](ObjectKey key) { return !m_store.isCurrent(key); });
  table.gone = 0;
}

}  // namespace df
