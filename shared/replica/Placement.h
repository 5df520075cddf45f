// Overrides the places at which a client draws objects, for example by its prediction of the player's object.
// It affects only drawing and is never part of the replica.
#pragma once

#include <cstdint>

#include "shared/replica/Records.h"

namespace naiad {

class Placement {
 public:
  virtual ~Placement() = default;
  /// Returns the position at which an object of the replica is drawn in the picture of `tick`.
  virtual df::FixedVector positionOf(const ObjectState& object, std::uint32_t tick) const = 0;
  /// Returns the upper left corner of the view; `modelled` is the corner according to the view's record.
  virtual df::FixedVector viewCorner(df::FixedVector modelled) const = 0;
};

}  // namespace naiad
