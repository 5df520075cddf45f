// A small world, the prelude, that a replica may know before the fuzzer's snapshots arrive, so that they can
// refer to it.
#pragma once

#include <array>

#include "Require.h"
#include "shared/replica/Replica.h"

namespace naiad::fuzz {

inline constexpr std::uint32_t kPreludeTick = 1000;
inline constexpr std::uint32_t kPreludeNames = 4;  ///< sequences 0 … 3 have names

/// Returns how many appearances the sequence with this name has; 1 if the prelude does not define it.
inline std::uint64_t preludeFrames(std::uint64_t name) {
  return name == 2 || name == 3 ? name : 1;
}

/// Returns the prelude's origin in this slot.
inline const Origin& preludeOrigin(std::uint64_t slot) {
  static const std::array<Origin, kOriginSlots + 1> kOrigins = [] {
    std::array<Origin, kOriginSlots + 1> origins;
    for (std::uint32_t i = 1; i <= kOriginSlots; ++i)
      origins[i] = {{static_cast<std::int32_t>(i) * 8 - 12, -6}, 6, 5, i * 100};
    return origins;
  }();
  return kOrigins[slot % kOrigins.size()];
}

/// Returns the snapshot (number 1, epoch 0) with this world: its size, a view that follows object 0, the
/// three origins, a text, the names, and six objects.
inline std::string preludeSnapshot() {
  SnapshotWriter writer;
  writer.beginSnapshot({1, kPreludeTick, 0, true, false, 0, 0}, 0, {});
  writer.write(WorldRecord{{{}, {df::fromCells(120), df::fromCells(50)}}, 40, 20, df::BLACK});
  writer.write(ViewRecord{{df::fromCells(3), 0}, true, 0, 1});
  for (std::uint32_t slot = 1; slot <= kOriginSlots; ++slot)
    writer.write(OriginRecord{slot, preludeOrigin(slot)});
  writer.write(TextRecord{1, 2, 0, df::GREEN, "Score 7"});
  for (std::uint32_t id = 0; id < 6; ++id) {
    ObjectState state;
    state.order = id + 1;
    state.motion = {kPreludeTick, {df::fromCells(5 * id), df::fromCells(3)}, {df::kFixedOne / 4, 0}, {}};
    Appearance word;
    for (std::int32_t i = 0; i <= static_cast<std::int32_t>(id); ++i)
      word.push_back({256 * i, 0, U'a', df::RED});
    state.look = {Sequence(std::vector<Appearance>(preludeFrames(id), word)), 2};
    if (preludeFrames(id) > 1) state.look.selector = Selector::clock(kPreludeTick, 4);
    BitWriter bits;
    const LookForm form = id < kPreludeNames ? LookForm{LookForm::kDefined, id} : LookForm{};
    writer.encode(bits, kAllGroups, 1, state, state.motion, form);
    writer.object(id, std::move(bits));
  }
  return writer.finish();
}

inline const Replica& preludeReplica() {
  static const Replica kept = [] {
    Replica replica(kPreludeTick);
    Snapshot snapshot;
    REQUIRE(replica.read(preludeSnapshot(), snapshot) == ReadResult::kOk);
    replica.apply(snapshot);
    return replica;
  }();
  return kept;
}

}  // namespace naiad::fuzz
