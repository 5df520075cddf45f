// Which build a file of code is of.
#pragma once

#include <cstddef>
#include <string>

namespace naiad {

/// Of an id in hex, at most.
inline constexpr std::size_t kMaxBuildId = 64;

/// Digits of an id that tell it from others in a line for people.
inline constexpr std::size_t kShownBuildId = 8;

/// The id that the linker wrote into a file that this process has loaded, in hex: another build has another.
/// `file`: how its name begins, as "libc.so". Empty if there is no such file, or no id in it.
std::string buildIdOf(const std::string& file);

/// That of libdragonfly.so, with which this code came. Any thread.
const std::string& ownBuildId();

}  // namespace naiad
