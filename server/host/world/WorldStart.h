// How a process knows that it is a world's: one end of a Unix socket, whose descriptor its environment names.
// WorldLauncher.h starts such processes.
#pragma once

#include <unistd.h>

#include <cstdint>
#include <optional>
#include <string>

#include "engine/world/ActivityPage.h"

namespace naiad {

/// The socket's descriptor in a world's process.
inline constexpr int kWorldSocket = STDERR_FILENO + 1;

/// That of the memory which it shares with its host: an ActivityPage.
inline constexpr int kWorldPage = kWorldSocket + 1;

/// That of the socket by which it is asked for copies (CopyMaker), if it is. Far from those that a game
/// opens, which have the same numbers with and without.
inline constexpr int kWorldCopies = 100;

/// What the environment of a world's process has for takeWorldSocket().
std::string worldSocketEntry();

/// What it has for takeWorldSeed().
std::string worldSeedEntry(std::uint64_t seed);

/// In a world's process: the seed that its front gave it. Nothing in others, and when it was asked for
/// before.
std::optional<std::uint64_t> takeWorldSeed();

/// In a world's process: its end of the socket. Nothing in others, and when it was asked for before.
std::optional<int> takeWorldSocket();

/// In a world's process, after takeWorldSocket() had one: the page for World::setActivityPage(), which stays
/// for ever. Null if there is none, which costs its host a word in the log.
df::ActivityPage* openWorldPage();

/// The working directory of when this library was loaded: a game's main() may go elsewhere.
const std::string& firstDirectory();

}  // namespace naiad
