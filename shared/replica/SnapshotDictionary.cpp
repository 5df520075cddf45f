#include "shared/replica/SnapshotDictionary.h"

#include "shared/replica/Acks.h"

namespace naiad {

template <class Value>
SnapshotDictionary::Find SnapshotDictionary::classify(const Named<Value>& named, std::uint32_t number) {
  if (named.number == 0) return Find::kUnknown;
  return isNewer(number, named.number) ? Find::kFound : Find::kStale;
}

SnapshotDictionary::Find SnapshotDictionary::find(std::uint32_t number, std::uint32_t slot,
                                                  Origin& out) const {
  if (slot > kOriginSlots) return Find::kUnknown;
  out = m_origins[slot].value;
  return slot == 0 ? Find::kFound : classify(m_origins[slot], number);
}

SnapshotDictionary::Find SnapshotDictionary::find(std::uint32_t number, std::uint32_t id,
                                                  const Sequence*& out) const {
  const auto found = m_sequences.find(id);
  if (found == m_sequences.end()) return Find::kUnknown;
  out = &found->second.value;
  return classify(found->second, number);
}

void SnapshotDictionary::define(std::uint32_t number, const OriginRecord& record) {
  Named<Origin>& origin = m_origins.at(record.slot);
  if (origin.number == 0 || isNewer(number, origin.number)) origin = {number, record.origin};
}

bool SnapshotDictionary::define(std::uint32_t number, const SequenceRecord& record) {
  Named<Sequence>& named = m_sequences[record.id];
  if (named.number != 0 && !isNewer(number, named.number)) return true;
  const std::size_t glyphs = m_glyphs - named.value.weight() + record.sequence.weight();
  if (glyphs > kMaxDictionaryGlyphs) return false;
  m_glyphs = glyphs;
  named = {number, record.sequence};
  return true;
}

}  // namespace naiad
