// Counts of the code paths that a world's moves have taken: tests check that each is taken, measurements say
// which were measured. Counted once for a run of Objects where there are many.
#pragma once

#include <array>
#include <cstdint>

namespace df {

struct MoverStats {
  // Turns in update.
  std::uint64_t flown = 0;    ///< SPECTRAL ones, moved side by side
  std::uint64_t walked = 0;   ///< solid ones that touched nothing
  std::uint64_t met = 0;      ///< solid ones that touched another
  std::uint64_t unheard = 0;  ///< solid ones in a crowd that heard nothing of it
  std::uint64_t deferred =
      0;  ///< of either kind, with more to it: out of the boundary, or the masks share no cell
  std::uint64_t special = 0;  ///< with an acceleration, an option, or a view that follows
  // Moves tested along their whole path: all of them, and those that searched again after a pass.
  std::uint64_t swept = 0;
  std::uint64_t swept_again = 0;
  // Queries of the broad phase for a turn: of characters at their nine cells, of boxes at a few cells, and of
  // both across the border of a block or on another level.
  std::uint64_t nine_cells = 0;
  std::uint64_t few_cells = 0;
  std::uint64_t far_cells = 0;
};

/// A count and its name, to print them.
struct NamedPath {
  const char* name;
  std::uint64_t MoverStats::*count;
};
inline constexpr std::array<NamedPath, 11> kMoverStats{{{"flown", &MoverStats::flown},
                                                        {"walked", &MoverStats::walked},
                                                        {"met", &MoverStats::met},
                                                        {"unheard", &MoverStats::unheard},
                                                        {"deferred", &MoverStats::deferred},
                                                        {"special", &MoverStats::special},
                                                        {"swept", &MoverStats::swept},
                                                        {"swept_again", &MoverStats::swept_again},
                                                        {"nine_cells", &MoverStats::nine_cells},
                                                        {"few_cells", &MoverStats::few_cells},
                                                        {"far_cells", &MoverStats::far_cells}}};

using Paths [[deprecated("say MoverStats")]] = MoverStats;

}  // namespace df
