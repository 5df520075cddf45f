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
  /// Work for all of it, at most, in boxes that are computed or compared: about two milliseconds. What the
  /// limit leaves out blocks nothing.
  static constexpr std::size_t kMaxWork = 200'000;

  /// Those among the replica's objects that can block `own` in the ticks after `first` up to `last`, if it
  /// goes no farther than `reach` on each axis from where the box `from` is.
  Surroundings(const Replica& replica, const ObjectState& own, const df::FixedBox& from,
               df::FixedVector reach, std::uint32_t first, std::uint32_t last);

  /// By the rules of the book's moveObject(): boxes that touch, HARD on HARD, or SOFT on a no-soft mover.
  /// Those created before `own` have moved when its turn comes, the others not yet.
  bool block(df::FixedVector to, std::uint32_t tick, bool in_update) const override;

  /// What it took until now.
  std::size_t work() const { return m_work; }

 private:
  struct Other {
    df::FixedBox along;  ///< around all its boxes in these ticks
    const ObjectState* p_state;
  };

  const ObjectState& m_own;
  std::vector<Other> m_others;
  mutable std::size_t m_work = 0;
};

}  // namespace naiad
