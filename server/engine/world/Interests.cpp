#include "engine/world/Interests.h"

#include <algorithm>
#include <cassert>

#include "engine/world/InterestDispatch.h"
#include "engine/world/Object.h"
#include "engine/world/ObjectExtras.h"
#include "engine/world/World.h"
#include "engine/world/WorldStore.h"

namespace df {

int Interests::add(Object& object, const std::string& type) {
  if (!m_world.store().has(object.m_slot, WorldStore::kInWorld)) return -1;
  const auto [it, is_new] = m_numbers.try_emplace(type, static_cast<std::uint32_t>(m_tables.size()));
  if (is_new) m_tables.emplace_back();
  auto& mine = object.m_p_profile->interests;
  if (std::find(mine.begin(), mine.end(), it->second) != mine.end()) return 0;
  mine.push_back(it->second);
  Table& table = m_tables[it->second];
  tidy(table);
  table.entries.push_back(object.key());
  return 0;
}

int Interests::remove(Object& object, const std::string& type) {
  const auto it = m_numbers.find(type);
  if (it == m_numbers.end() || std::erase(object.m_p_profile->interests, it->second) == 0) return -1;
  Table& table = m_tables[it->second];
  const auto entry = std::find(table.entries.begin(), table.entries.end(), object.key());
  assert(entry != table.entries.end());  // the Object lists only types for which it has an entry
  *entry = ObjectKey{};
  ++table.gone;
  tidy(table);
  return 0;
}

// The entries need no search: the Object's generation ends, so they name no Object.
void Interests::dropAll(Object& object) {
  for (std::uint32_t number : object.m_p_profile->interests) ++m_tables[number].gone;
  object.m_p_profile->interests.clear();
}

void Interests::tidy(Table& table) {
  if (table.walks > 0 || table.gone < 16 || table.gone * 2 < table.entries.size()) return;
  std::erase_if(table.entries, [this](ObjectKey key) { return !m_world.store().isCurrent(key); });
  table.gone = 0;
}

bool Interests::hearsWhilePaused(const Object* p_object) {
  return p_object != nullptr && p_object->m_p_extras != nullptr && p_object->m_p_extras->hears_while_paused;
}

int Interests::send(const Event& event, Audience audience) {
  const auto it = m_numbers.find(event.getType());
  if (it == m_numbers.end()) return 0;
  Table& table = m_tables[it->second];
  const std::size_t count = table.entries.size();
  int delivered = 0;
  m_world.nameClassOf(event);
  ++table.walks;
  for (std::size_t i = 0; i < count; ++i) {
    if (audience == kWhilePaused && !hearsWhilePaused(m_world.find(table.entries[i]))) continue;
    delivered += m_world.deliver(table.entries[i], event) ? 1 : 0;
  }
  --table.walks;
  tidy(table);
  return delivered;
}

}  // namespace df
