// The appearances that snapshots to one client can reference by id instead of describing them.
#pragma once

#include <algorithm>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "shared/replica/Acks.h"
#include "shared/replica/LookCodec.h"

namespace naiad {

/// An appearance is described, with an id, until a snapshot that carried the id is acknowledged; after that,
/// snapshots carry only the id. Appearances with very many glyphs get no id. If the limit of ids or glyphs is
/// reached, the least recently used ids are reassigned. A snapshot in which such an id still has its old
/// meaning is dropped by the client as stale, so it counts as lost.
class AppearanceIds {
 public:
  /// Returns how to write the appearance with this hash and number of glyphs in the snapshot being built.
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
    const bool in_this_one = name.used == snapshot;  // true if already written in this snapshot
    return {name.confirmed || in_this_one ? LookForm::kNamed : LookForm::kDefined, name.id};
  }
  /// Call when the appearance was written in the form that formOf() returned.
  void markUsed(std::uint64_t hash, std::uint32_t snapshot) {
    const auto found = m_names.find(hash);
    if (found != m_names.end()) found->second.used = snapshot;
  }
  /// Call when the snapshot that defined `id` arrived.
  void confirmArrival(std::uint32_t id, std::uint64_t hash, std::uint32_t snapshot) {
    const auto found = m_names.find(hash);
    if (found == m_names.end() || found->second.id != id || isNewer(found->second.assigned, snapshot)) return;
    found->second.confirmed = true;
  }
  /// Call when the client has been reset.
  void clear() { *this = {}; }

 private:
  /// Limit of the glyphs of all appearances with an id: half of the client's limit, because the client keeps
  /// the old meaning of an id until the id has a new one.
  static constexpr std::size_t kMaxGlyphs = kMaxDictionaryGlyphs / 2;
  struct Name {
    std::uint32_t id = 0;
    std::size_t glyphs = 0;
    std::uint32_t assigned = 0;  ///< first snapshot in which the id means this appearance
    std::uint32_t used = 0;      ///< newest snapshot that used the id; 0: none
    bool confirmed = false;
  };
  /// Frees the id used least recently. False if `snapshot` itself uses all ids.
  bool retireOldest(std::uint32_t snapshot) {
    // An id has one meaning in a snapshot, so ids that this snapshot uses are kept.
    const auto oldest = std::min_element(m_names.begin(), m_names.end(), [](const auto& a, const auto& b) {
      return isNewer(b.second.used, a.second.used);
    });
    if (oldest->second.used == snapshot) return false;
    m_free.push_back(oldest->second.id);
    m_glyphs -= oldest->second.glyphs;
    m_names.erase(oldest);
    return true;
  }

  std::unordered_map<std::uint64_t, Name> m_names;  ///< keyed by hash
  std::vector<std::uint32_t> m_free;
  std::uint32_t m_next_id = 0;
  std::size_t m_glyphs = 0;
};

}  // namespace naiad
