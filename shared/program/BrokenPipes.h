// Writing to a pipe or socket whose reader has gone is an error, and not the end of the process.
#pragma once

#include <cstddef>

namespace naiad {

/// How many files and sockets this process may have open.
/// Raise the soft limit to `wanted`, or as far as the system lets us. What is allowed now, which may be less.
/// Never lowers it.
std::size_t allowOpenFiles(std::size_t wanted);

/// Unless the process handles SIGPIPE already, a write to a pipe without a reader fails with EPIPE from now
/// on. Programs that this process starts have the default again.
void surviveBrokenPipes();

}  // namespace naiad
