// The interface between a replayable world's process and the library preloaded into it (server/repeat).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace naiad {

/// Start parameters of one world.
struct WorldStartOptions {
  /// Random seed; 0: the world's options give it or, if they do not, the world chooses one.
  std::uint64_t seed = 0;
  /// True if replaying its turns makes an equal world: it gets fixed addresses, and clocks and entropy that
  /// depend only on these options, the tick and the game's calls (server/repeat).
  bool repeatable = false;
  bool again = false;   ///< the world is a replay, so it does not sleep
  bool copies = false;  ///< the world makes copies of itself on request (WorldCheckpoints.h)
  bool reads_only =
      false;  ///< in a sandbox, this world cannot write files, because another world writes them
  std::uint64_t start_nanos = 0;  ///< the world's clock at its start, in nanoseconds since 1970 (UTC)
  std::uint64_t frame_nanos = 0;  ///< length of a tick, in nanoseconds
};

/// A file that the game read before its first turn.
struct ReadFile {
  std::string name;        ///< folder and name, without the rest of its path
  std::uint64_t hash = 0;  ///< FastHash of its bytes; 0: unreadable, or larger than 64 MiB
};
inline constexpr std::size_t kMaxReadFiles = 256;
inline constexpr std::size_t kMaxReadFileName = 200;

/// Returns the value of LD_PRELOAD for worlds: the library, after this process's sanitizer runtime (if
/// any), which must be loaded first. Empty if the library is missing.
std::string determinismPreload();
/// Returns the environment entry with the library's settings.
std::string determinismEntry(const WorldStartOptions& order);

// The world's process calls the following functions. Without the library, they do nothing.

/// Sets the number of the next tick to begin.
void setDeterminismTick(std::uint32_t tick);
/// Returns the files read so far, and stops recording them.
std::vector<ReadFile> popReadFiles();

}  // namespace naiad
