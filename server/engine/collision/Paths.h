// Which ways through the engine the moves of a world have taken: to see in tests that none goes untried, and
// in measurements what was measured. Counted by the run, not by the Object, where there are many.
#pragma once

#include <array>
#include <cstdint>

namespace df {

struct Paths {
  // Turns in update.
  std::uint64_t flown = 0;   ///< SPECTRAL ones, moved side by side
  std::uint64_t walked = 0;  ///< solid ones that met nobody
  std::uint64_t met = 0;     ///< solid ones that met somebody
  std::uint64_t deferred =
      0;  ///< of either kind, with more to it: out of the boundary, or a mask did not meet
  std::uint64_t special = 0;  ///< with an acceleration, an option, or a view that follows
  // Moves tested all along their way: all of them, and those that searched again after a pass.
  std::uint64_t swept = 0;
  std::uint64_t swept_again = 0;
  // Looks of the broad phase for a turn: of characters at their nine cells, of boxes at a few cells, and of
  // both across the border of a block or on another level.
  std::uint64_t nine_cells = 0;
  std::uint64_t few_cells = 0;
  std::uint64_t far_cells = 0;
};

/// A path and its name, for those who print them.
struct NamedPath {
  const char* name;
  std::uint64_t Paths::*count;
};
inline constexpr std::array<NamedPath, 10> kPaths{{{"flown", &Paths::flown},
                                                   {"walked", &Paths::walked},
                                                   {"met", &Paths::met},
                                                   {"deferred", &Paths::deferred},
                                                   {"special", &Paths::special},
                                                   {"swept", &Paths::swept},
                                                   {"swept_again", &Paths::swept_again},
                                                   {"nine_cells", &Paths::nine_cells},
                                                   {"few_cells", &Paths::few_cells},
                                                   {"far_cells", &Paths::far_cells}}};

}  // namespace df
