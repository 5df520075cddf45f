// The start of a world's process. Its environment names the descriptor of a Unix socket to its host.
// WorldLauncher.h starts such processes.
#pragma once

#include <unistd.h>

#include <cstdint>
#include <optional>
#include <string>

#include "engine/world/ActivityPage.h"

namespace naiad {

/// Descriptor of the socket to the host in a world's process.
inline constexpr int kWorldSocket = STDERR_FILENO + 1;

/// Descriptor of the memory shared with the host: an ActivityPage.
inline constexpr int kWorldPage = kWorldSocket + 1;

/// Descriptor of the socket for requests to copy the world (CheckpointForker); open only if the front makes
/// them. It is high, so that the descriptors that a game opens have equal numbers with and without it.
inline constexpr int kWorldCheckpoints = 100;

/// Returns the environment entry for takeWorldSocket().
std::string worldSocketEntry();

/// Returns the environment entry for takeWorldSeed().
std::string worldSeedEntry(std::uint64_t seed);

/// Returns the seed that the front gave this world, once; nullopt if it gave none, or in other processes.
std::optional<std::uint64_t> takeWorldSeed();

/// Returns this world's end of the socket, once; nullopt in other processes.
std::optional<int> takeWorldSocket();

/// Maps the page for World::setActivityPage(), for the life of the process. Call after takeWorldSocket()
/// returned a socket. Returns null if there is no page; then the host's log has fewer details.
df::ActivityPage* openWorldPage();

/// Returns the working directory at the time this library was loaded. A game's main() may change it.
const std::string& firstDirectory();

}  // namespace naiad
