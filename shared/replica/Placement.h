// Where things are drawn, if not where their models say: what a client adds to the picture by itself, like
// the prediction of the player's object. A drawing rule, never part of the replica.
#pragma once

#include <cstdint>

#include "shared/replica/Records.h"

namespace naiad {

class Placement {
 public:
  virtual ~Placement() = default;
  /// Where an object of the replica is drawn in the picture of `tick`.
  virtual df::FixedVector positionOf(const ObjectState& object, std::uint32_t tick) const = 0;
  /// Where the upper left corner of the view is; by the view's record it would be at `modelled`.
  virtual df::FixedVector viewCorner(df::FixedVector modelled) const = 0;
};

}  // namespace naiad
