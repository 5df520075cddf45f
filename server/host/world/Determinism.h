// The interface between a replayable world's process and the library that is loaded into it before all others
// (server/repeat).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace naiad {

/// Start parameters of one world.
struct WorldStartOptions {
  /// Seed; 0: the world takes one of its own, unless the options have one.
  std::uint64_t seed = 0;
  /// Replaying its turns makes an equal world: it gets fixed addresses, and clocks and entropy from the seed
  /// and the tick (server/repeat).
  bool repeatable = false;
  bool again = false;             ///< a replay: it does not sleep
  bool copies = false;            ///< it makes copies of itself on order (WorldCheckpoints.h)
  bool reads_only = false;        ///< in a sandbox it writes no files, because another world does
  std::uint64_t start_nanos = 0;  ///< its clock at the start, since 1970 in UTC
  std::uint64_t frame_nanos = 0;  ///< length of a tick
};

/// A file that the game read before its first turn.
struct ReadFile {
  std::string name;        ///< folder and name, without the rest of its path
  std::uint64_t hash = 0;  ///< FastHash of its bytes; 0: it could not be read
};
inline constexpr std::size_t kMaxReadFiles = 256;
inline constexpr std::size_t kMaxReadFileName = 200;

/// Returns the value of LD_PRELOAD: the library, after the sanitizer's runtime of this process, which must be
/// the first. Empty if the library is missing.
std::string determinismPreload();
/// Returns the environment entry with the library's settings.
std::string determinismEntry(const WorldStartOptions& order);

// The world's process calls these. They do nothing without the library.

/// Sets the number of the next tick to begin.
void setDeterminismTick(std::uint32_t tick);
/// Returns the files read so far, and stops recording them.
std::vector<ReadFile> popReadFiles();

}  // namespace naiad
