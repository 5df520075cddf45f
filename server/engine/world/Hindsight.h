// What players saw when they did something: the seam through which a host lets a game look back.
//
// Between a player's click and the tick that handles it, what he clicked on has flown on. A host that knows
// what each client was told can say where it was drawn; without one, everything was drawn where it is.
#pragma once

#include <cstdint>
#include <optional>

#include "Fixed.h"
#include "detail/WorldView.h"

namespace df {

/// Which picture a player had before him.
struct Seen {
  bool known = false;       ///< false: nobody says
  std::uint32_t base = 0;   ///< the newest tick that his client had heard of
  std::uint32_t drawn = 0;  ///< the tick that it drew, by what it knew of `base`
};

class Hindsight {
 public:
  virtual ~Hindsight() = default;
  /// Where the Object was drawn in that picture; nothing if it was not in it.
  virtual std::optional<FixedVector> positionOf(ObjectKey object, const Seen& seen) const = 0;
  /// Where the upper left corner of the player's view was in that picture, world coordinates; nothing if
  /// nobody knows: then it counts where it is.
  virtual std::optional<FixedVector> viewCornerOf(std::uint32_t player, const Seen& seen) const = 0;
};

}  // namespace df
