// The appearances that snapshots to one client can name instead of spelling them out.
#pragma once

#include <algorithm>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "shared/replica/Acks.h"
#include "shared/replica/LookCodec.h"

namespace naiad {

/// An appearance is spelled out, with an id, until a snapshot that carried the id is acknowledged; from then
/// on snapshots carry the id alone. When all ids are taken, the least recently used one is reassigned. The
/// client drops a snapshot that still meant the old appearance as stale, so that snapshot counts as lost.
class AppearanceNames {
 public:
  /// How to write the appearance with this hash and so many glyphs in the snapshot being built.
  LookForm formOf(std::uint64_t hash, std::size_t glyphs, std::uint32_t snapshot) {
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
  /// The appearance was written in that form.
  void markUsed(std::uint64_t hash, std::uint32_t snapshot) {
    const auto found = m_names.find(hash);
    if (found != m_names.end()) found->second.used = snapshot;
  }
  /// The snapshot that defined `id` arrived.
  void confirmArrival(std::uint32_t id, std::uint64_t hash, std::uint32_t snapshot) {
    const auto found = m_names.find(hash);
    if (found == m_names.end() || found->second.id != id || isNewer(found->second.assigned, snapshot)) return;
    found->second.confirmed = true;
  }
  /// The client has been reset.
  void clear() { *this = {}; }

 private:
  /// Half of what the client holds, since it keeps the old meaning of an id until the id has a new one.
  static constexpr std::size_t kMaxGlyphs = kMaxDictionaryGlyphs / 2;
  struct Name {
    std::uint32_t id = 0;
    std::size_t glyphs = 0;
    std::uint32_t assigned =
        0;                   ///< the snapshot for which it got the id; older ones meant another appearance
    std::uint32_t used = 0;  ///< the newest snapshot that used it; 0: none yet
    bool confirmed = false;
  };
  /// False if `snapshot` itself uses all names.
  bool retireOldest(std::uint32_t snapshot) {
    // Within one snapshot an id has one meaning, so what it uses keeps its id.
    const auto oldest = std::min_element(m_names.begin(), m_names.end(), [](const auto& a, const auto& b) {
      return isNewer(b.second.used, a.second.used);
    });
    if (oldest->second.used == snapshot) return false;
    m_free.push_back(oldest->second.id);
    m_glyphs -= oldest->second.glyphs;
    m_names.erase(oldest);
    return true;
  }

  std::unordered_map<std::uint64_t, Name> m_names;  ///< by hash
  std::vector<std::uint32_t> m_free;
  std::uint32_t m_next_id = 0;
  std::size_t m_glyphs = 0;
};

}  // namespace naiad
