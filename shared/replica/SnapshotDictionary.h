// What snapshots have defined for their receiver: origins to count from, sequences of appearances to draw.
#pragma once

#include <array>
#include <cstdint>
#include <unordered_map>

#include "shared/replica/Records.h"

namespace naiad {

/// Ids of sequences: 0 … 4095.
inline constexpr int kAppearanceIdBits = 12;
inline constexpr std::uint32_t kMaxAppearances = 1u << kAppearanceIdBits;
/// Glyphs of all named sequences together (Sequence::weight); a definition beyond that is refused.
inline constexpr std::size_t kMaxDictionaryGlyphs = 65'536;

/// Each entry keeps the number of the snapshot that set it. A snapshot that names an entry which a newer one
/// has set since is *stale*: the old value is gone, so it must be dropped unacknowledged, as if it were lost.
class SnapshotDictionary {
 public:
  enum class Find { kFound, kStale, kUnknown };

  /// The origin that snapshot `number` means by `slot`.
  Find find(std::uint32_t number, std::uint32_t slot, Origin& out) const;
  /// The sequence that snapshot `number` means by `id`; it stays valid until the next define().
  Find find(std::uint32_t number, std::uint32_t id, const Sequence*& out) const;

  /// Store a definition of snapshot `number`; numbers older than the newest of an entry are ignored. False if
  /// the dictionary is full.
  void define(std::uint32_t number, const OriginRecord& record);
  bool define(std::uint32_t number, const SequenceRecord& record);

 private:
  template <class Value>
  struct Named {
    std::uint32_t number = 0;  ///< of the snapshot that set it; 0: not set
    Value value;
  };
  template <class Value>
  static Find judge(const Named<Value>& named, std::uint32_t number);

  std::array<Named<Origin>, kOriginSlots + 1> m_origins;
  std::unordered_map<std::uint32_t, Named<Sequence>> m_sequences;
  std::size_t m_glyphs = 0;
};

}  // namespace naiad
