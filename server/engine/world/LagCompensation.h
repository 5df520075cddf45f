// The interface by which a host provides what was on a player's screen when the player acted.
//
// Between a click and the tick that handles it, the clicked Object moves on. A host that knows which
// snapshots each client has received can compute where an Object was drawn. Without such a host, the present
// positions are used.
#pragma once

#include <cstdint>
#include <optional>

#include "Fixed.h"
#include "detail/WorldView.h"

namespace df {

/// Identifies the picture that was on a player's screen.
struct ViewedTick {
  bool known = false;       ///< false: the other fields mean nothing
  std::uint32_t base = 0;   ///< the newest tick of which the client had a snapshot
  std::uint32_t drawn = 0;  ///< the tick that the client drew, extrapolated from `base`
};

class LagCompensation {
 public:
  virtual ~LagCompensation() = default;
  /// Returns the position at which the Object was drawn in that picture; nullopt if it was not drawn.
  virtual std::optional<FixedVector> positionOf(ObjectKey object, const ViewedTick& seen) const = 0;
  /// Returns the upper left corner of the player's view in that picture, in world coordinates; nullopt if it
  /// is unknown, so that the present corner is used.
  virtual std::optional<FixedVector> viewCornerOf(std::uint32_t player, const ViewedTick& seen) const = 0;
};

using Seen [[deprecated("say ViewedTick")]] = ViewedTick;
using Hindsight [[deprecated("say LagCompensation")]] = LagCompensation;

}  // namespace df
