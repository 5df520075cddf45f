// Which appearances one client can be told by name.
#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "shared/replica/LookCodec.h"

namespace naiad {

/// An appearance is spelled out, with an id, until a snapshot that carried the id is acknowledged; from then
/// on the id is enough. The least recently used id is given away when all are taken: a snapshot that still
/// meant the old one by it is dropped by the client as stale, so it counts as lost.
class AppearanceNames {
 public:
  /// How to write the appearance with this hash and so many glyphs in the snapshot being built.
  LookForm formOf(std::uint64_t hash, std::size_t glyphs, std::uint32_t snapshot);
  /// It was written so.
  void wrote(std::uint64_t hash, std::uint32_t snapshot);
  /// The snapshot that defined `id` arrived.
  void arrived(std::uint32_t id, std::uint64_t hash, std::uint32_t snapshot);
  /// The client has forgotten all.
  void clear();

 private:
  /// Half of what the client holds, for it keeps what an id meant until the id means something else.
  static constexpr std::size_t kMaxGlyphs = kMaxVocabularyGlyphs / 2;
  struct Name {
    std::uint32_t id = 0;
    std::size_t glyphs = 0;
    std::uint32_t given = 0;  ///< the snapshot for which it got the id: older ones meant another by it
    std::uint32_t used = 0;   ///< the newest snapshot that meant it; 0: none yet
    bool confirmed = false;
  };
  /// False if `snapshot` itself uses all that there are.
  bool retireOldest(std::uint32_t snapshot);

  std::unordered_map<std::uint64_t, Name> m_names;  ///< by hash
  std::vector<std::uint32_t> m_free;
  std::uint32_t m_next_id = 0;
  std::size_t m_glyphs = 0;
};

}  // namespace naiad
