// What can block the player's own object, according to the replica.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "shared/replica/Replica.h"
#include "shared/replica/SteeredCopy.h"

namespace naiad {

/// The box of an object at this position, in world coordinates; nothing beyond 10^9 cells, where nothing
/// can block.
std::optional<df::FixedBox> boxAt(const Body& body, df::FixedVector position);

/// The smallest box around all boxes of the object in the ticks from `first` to `last`, both included;
/// nothing if it has none.
std::optional<df::FixedBox> boxAlong(const ObjectState& object, std::uint32_t first, std::uint32_t last);

class Surroundings : public Barriers {
 public:
  /// Those among the replica's objects that can block `own` in the ticks after `first` up to `last`, if it
  /// goes no farther than `reach` on each axis from where the box `from` is.
  Surroundings(const Replica& replica, const ObjectState& own, const df::FixedBox& from,
               df::FixedVector reach, std::uint32_t first, std::uint32_t last);

  /// By the rules of the book's moveObject(): boxes that touch, HARD on HARD, or SOFT on a no-soft mover.
  /// Those created before `own` have moved when its turn comes, the others not yet.
  bool block(df::FixedVector to, std::uint32_t tick, bool in_update) const override;

 private:
  const ObjectState& m_own;
  std::vector<const ObjectState*> m_others;
};

}  // namespace naiad
