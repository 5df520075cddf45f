#include "host/snapshot/AppearanceNames.h"

#include <algorithm>

#include "shared/replica/Acks.h"

namespace naiad {

LookForm AppearanceNames::formOf(std::uint64_t hash, std::size_t glyphs, std::uint32_t snapshot) {
  if (glyphs > kMaxGlyphs / 8) return {};
  auto found = m_names.find(hash);
  if (found == m_names.end()) {
    while (!m_names.empty() && (m_glyphs + glyphs > kMaxGlyphs || m_names.size() == kMaxAppearances)) {
      if (!retireOldest(snapshot)) return {};
    }
    std::uint32_t id = m_next_id;
    if (m_free.empty()) {
      ++m_next_id;
    } else {
      id = m_free.back();
      m_free.pop_back();
    }
    found = m_names.emplace(hash, Name{id, glyphs, snapshot, 0, false}).first;
    m_glyphs += glyphs;
  }
  const Name& name = found->second;
  const bool in_this_one = name.used == snapshot;  // this snapshot has it already
  return {name.confirmed || in_this_one ? LookForm::kNamed : LookForm::kDefined, name.id};
}

void AppearanceNames::markUsed(std::uint64_t hash, std::uint32_t snapshot) {
  const auto found = m_names.find(hash);
  if (found != m_names.end()) found->second.used = snapshot;
}

// Within one snapshot an id has one meaning, so what it uses keeps its id.
bool AppearanceNames::retireOldest(std::uint32_t snapshot) {
  const auto oldest = std::min_element(m_names.begin(), m_names.end(), [](const auto& a, const auto& b) {
    return isNewer(b.second.used, a.second.used);
  });
  if (oldest->second.used == snapshot) return false;
  m_free.push_back(oldest->second.id);
  m_glyphs -= oldest->second.glyphs;
  m_names.erase(oldest);
  return true;
}

void AppearanceNames::confirmArrival(std::uint32_t id, std::uint64_t hash, std::uint32_t snapshot) {
  const auto found = m_names.find(hash);
  if (found == m_names.end() || found->second.id != id || isNewer(found->second.assigned, snapshot)) return;
  found->second.confirmed = true;
}

void AppearanceNames::clear() {
  *this = {};
}

}  // namespace naiad
