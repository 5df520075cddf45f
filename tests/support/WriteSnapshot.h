// Writes a snapshot from a header and records.
#pragma once

#include <string>

#include "shared/replica/SnapshotCodec.h"

namespace naiad::test {

/// Encodes the snapshot, with all sequences in full. The reader must know `origin` as that of `slot`.
inline std::string writeSnapshot(const SnapshotHeader& header, const Records& records, std::uint32_t slot = 0,
                                 const Origin& origin = {}) {
  SnapshotWriter out;
  out.beginSnapshot(header, slot, origin);
  for (const WorldRecord& record : records.worlds) out.write(record);
  for (const ViewRecord& record : records.views) out.write(record);
  for (const OriginRecord& record : records.origins) out.write(record);
  for (const TextRecord& record : records.texts) out.write(record);
  for (const ObjectRecord& record : records.objects) {
    BitWriter bits;
    out.encode(bits, record.groups, record.generation, record.state, record.state.motion);
    out.object(record.id, std::move(bits));
  }
  return out.finish();
}

/// Returns the context from which a reader restores the numbers of `header`.
inline SnapshotContext near(const SnapshotHeader& header) {
  return {header.number, header.tick, header.input};
}

}  // namespace naiad::test
