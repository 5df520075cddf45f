// A world's process that can be executed again: what the library that is loaded before all others
// (server/repeat) and the world say to each other.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "host/world/WorldOrder.h"

namespace naiad {

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
