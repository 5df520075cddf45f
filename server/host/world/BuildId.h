// The build ids of programs and libraries.
#pragma once

#include <cstddef>
#include <string>

namespace naiad {

/// Maximum digits of an id in hex.
inline constexpr std::size_t kMaxBuildId = 64;

/// Digits of an id in messages: enough to tell builds apart.
inline constexpr std::size_t kShownBuildId = 8;

/// Returns the id that the linker wrote into a file loaded by this process, in hex. Each build has its own.
/// `file`: the beginning of its name, like "libc.so". Empty if there is no such file, or no id in it.
std::string buildIdOf(const std::string& file);

/// Returns the id of libdragonfly.so, which contains this code; empty if it has no id. Any thread.
const std::string& ownBuildId();

}  // namespace naiad
