// What one world of a launcher gets that another does not.
#pragma once

#include <cstdint>

namespace naiad {

struct WorldOrder {
  /// 0: it takes one of its own, unless the options say one.
  std::uint64_t seed = 0;
  /// Executed again from the same turns, it is to be the same world: fixed addresses, and clocks and entropy
  /// from the seed and the tick (server/repeat).
  bool repeatable = false;
  bool again = false;             ///< it is executed again: it sleeps for no clock
  bool copies = false;            ///< it makes copies of itself when it is asked to (WorldCopies.h)
  bool reads_only = false;        ///< with a sandbox, it writes no files: another world of the game does
  std::uint64_t start_nanos = 0;  ///< its clock at the start, since 1970 in UTC
  std::uint64_t frame_nanos = 0;  ///< length of a tick
};

}  // namespace naiad
