// Definitions that a receiver has read from snapshots: origins of positions, sequences of appearances.
#pragma once

#include <array>
#include <cstdint>
#include <unordered_map>

#include "shared/replica/Records.h"

namespace naiad {

/// Size of sequence ids in bits. Ids are 0 … 4095.
inline constexpr int kAppearanceIdBits = 12;
inline constexpr std::uint32_t kMaxAppearances = 1u << kAppearanceIdBits;
/// Limit of the glyphs of all named sequences together (Sequence::weight); a definition beyond it is refused.
inline constexpr std::size_t kMaxDictionaryGlyphs = 65'536;

/// Each entry has the number of the snapshot that set it. A snapshot is *stale* if it refers to an entry that
/// a newer one has set. The old value is gone, so the snapshot must be dropped unacknowledged, as if lost.
class SnapshotDictionary {
 public:
  enum class Find { kFound, kStale, kUnknown };

  /// Finds the origin to which snapshot `number` refers by `slot`.
  Find find(std::uint32_t number, std::uint32_t slot, Origin& out) const;
  /// Finds the sequence to which snapshot `number` refers by `id`; it is valid until the next define().
  Find find(std::uint32_t number, std::uint32_t id, const Sequence*& out) const;

  /// Stores a definition of snapshot `number` unless a newer one exists. False if the dictionary is full.
  void define(std::uint32_t number, const OriginRecord& record);
  bool define(std::uint32_t number, const SequenceRecord& record);

 private:
  template <class Value>
  struct Named {
    std::uint32_t number = 0;  ///< the snapshot that set it; 0: not set
    Value value;
  };
  template <class Value>
  static Find classify(const Named<Value>& named, std::uint32_t number);

  std::array<Named<Origin>, kOriginSlots + 1> m_origins;
  std::unordered_map<std::uint32_t, Named<Sequence>> m_sequences;
  std::size_t m_glyphs = 0;
};

}  // namespace naiad
