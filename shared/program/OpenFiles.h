// How many files and sockets this process may have open.
#pragma once

#include <cstddef>

namespace naiad {

/// Raise the soft limit to `wanted`, or as far as the system lets us. What is allowed now, which may be less.
/// Never lowers it.
std::size_t allowOpenFiles(std::size_t wanted);

}  // namespace naiad
