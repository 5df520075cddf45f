// A world's process that can be executed again: what the library that is loaded before all others
// (server/repeat) and the world say to each other.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace naiad {

/// What one world of a launcher gets that another does not.
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

/// A file that the game read before its first turn.
struct ReadFile {
  std::string name;        ///< with the folder that it lies in, no more of its path
  std::uint64_t hash = 0;  ///< FastHash of its bytes; 0: it could not be read again
};
inline constexpr std::size_t kMaxReadFiles = 256;
inline constexpr std::size_t kMaxReadFileName = 200;

/// For LD_PRELOAD: the library, after a sanitizer's runtime that this process has, which wants to be the
/// first. Empty: it is not there.
std::string repeatPreload();
/// The entry of the environment by which the library knows what to do.
std::string repeatEntry(const WorldOrder& order);

// In the world's process; without the library these do nothing.

/// The next tick to begin.
void setRepeatTick(std::uint32_t tick);
/// Those so far. None are noted from now on.
std::vector<ReadFile> takeReadFiles();

}  // namespace naiad
