// The numbers that bodies accept from a game, and which of them take part in a tick.
#pragma once

#include <cmath>

#include "engine/world/WorldStore.h"
#include "shared/values/Vector.h"

namespace df {

inline constexpr double kMaxOfBody = 1e30;  ///< of any number: products of two stay finite
inline constexpr double kMaxSpin = 1e6;  ///< rad per tick: an angle gains no more than a double resolves well

// All are false for NaN.

inline bool isUsable(double value) {
  return std::abs(value) <= kMaxOfBody;
}
inline bool isUsable(Vector v) {
  return isUsable(v.x()) && isUsable(v.y());
}
inline bool isUsableSize(double value) {
  return value >= 0 && value <= kMaxOfBody;
}

/// Of what is a body: is it there, and neither inactive nor about to be deleted?
inline bool takesPart(const WorldStore& store, ObjectKey key) {
  constexpr std::uint32_t kNeeded = WorldStore::kInWorld | WorldStore::kActive | WorldStore::kBody;
  return store.isCurrent(key) && (store.flags(key.slot) & kNeeded) == kNeeded;
}

}  // namespace df
