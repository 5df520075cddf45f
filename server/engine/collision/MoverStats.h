// Counts of the code paths that a world's moves have taken: tests check that each is taken, measurements show
// which were measured. Objects that are moved together are counted one by one, but added in one step.
#pragma once

#include <array>
#include <cstdint>

namespace df {

struct MoverStats {
  // Turns of Objects in update(), by what happened in them.
  std::uint64_t flown = 0;     ///< SPECTRAL Objects in consecutive slots, moved together
  std::uint64_t walked = 0;    ///< solid Objects that touched nothing, and those of `unheard` that moved
  std::uint64_t met = 0;       ///< solid Objects that touched another
  std::uint64_t unheard = 0;   ///< solid Objects that touched many others, none with a handler
  std::uint64_t deferred = 0;  ///< fliers and walkers that left the boundary, or whose masks shared no cell
  std::uint64_t special = 0;   ///< others, for example with an acceleration, an option or a following view
  // Swept moves, and searches of such moves repeated because a pair that could block them did not.
  std::uint64_t swept = 0;
  std::uint64_t swept_again = 0;
  // Queries of the broad phase for a turn: characters at their nine cells, boxes at a few cells, and either
  // kind across the border of a block.
  std::uint64_t nine_cells = 0;
  std::uint64_t few_cells = 0;
  std::uint64_t far_cells = 0;
};

/// A count and its name, for printing.
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
