// Finds the replica's objects that can block the player's own object.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "shared/replica/PredictedObject.h"
#include "shared/replica/Replica.h"

namespace naiad {

/// Returns the object's box in world coordinates; nullopt beyond 10^9 cells, where nothing can block.
std::optional<df::FixedBox> boxAt(const Body& body, df::FixedVector position);

/// Returns the smallest box around all boxes of the object in the ticks from `first` to `last`, both
/// included; nullopt if one of them is beyond 10^9 cells.
std::optional<df::FixedBox> boxAlong(const ObjectState& object, std::uint32_t first, std::uint32_t last);

class ReplicaBarriers : public Barriers {
 public:
  /// Work limit in boxes computed or compared: about two milliseconds. After it, other objects do not block.
  static constexpr std::size_t kMaxWork = 200'000;

  /// Collects the replica's objects that can block `own` in the ticks after `first` up to `last`, if it moves
  /// no farther than `reach` on each axis from the box `from`.
  ReplicaBarriers(const Replica& replica, const ObjectState& own, const df::FixedBox& from,
                  df::FixedVector reach, std::uint32_t first, std::uint32_t last);

  /// Returns true if the object is blocked at `to`, by the rules of Dragonfly's moveObject(): its box touches
  /// that of a HARD object (HARD mover) or of a SOFT one (no-soft mover). During an update, objects created
  /// before `own` have already moved in this tick, the others have not.
  bool isBlocked(df::FixedVector to, std::uint32_t tick, bool in_update) const override;

  /// Returns the work done so far.
  std::size_t work() const { return m_work; }

 private:
  struct Other {
    df::FixedBox along;  ///< smallest box around all its boxes in the ticks
    const ObjectState* p_state;
  };

  const ObjectState& m_own;
  std::vector<Other> m_others;
  mutable std::size_t m_work = 0;
};

}  // namespace naiad
