// Lag compensation: the seam through which a host says what was on a player's screen when the player acted.
//
// Between a click and the tick that handles it, the Object that was clicked on has moved. A host that knows
// which snapshots each client has received can say where an Object was drawn; without one, Objects count
// where they are.
#pragma once

#include <cstdint>
#include <optional>

#include "Fixed.h"
#include "detail/WorldView.h"

namespace df {

/// Which picture was on a player's screen.
struct ViewedTick {
  bool known = false;       ///< false: the other fields mean nothing
  std::uint32_t base = 0;   ///< the newest tick of which the client had a snapshot
  std::uint32_t drawn = 0;  ///< the tick that it drew, extrapolated from `base`
};

class LagCompensation {
 public:
  virtual ~LagCompensation() = default;
  /// Where the Object was drawn in that picture; nothing if it was not in it.
  virtual std::optional<FixedVector> positionOf(ObjectKey object, const ViewedTick& seen) const = 0;
  /// Where the upper left corner of the player's view was in that picture, world coordinates; nothing if
  /// that is unknown: then it counts where it is.
  virtual std::optional<FixedVector> viewCornerOf(std::uint32_t player, const ViewedTick& seen) const = 0;
};

using Seen [[deprecated("say ViewedTick")]] = ViewedTick;
using Hindsight [[deprecated("say LagCompensation")]] = LagCompensation;

}  // namespace df
