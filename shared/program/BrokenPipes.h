// Writing to a pipe or socket whose reader has gone is an error, and not the end of the process.
#pragma once

namespace naiad {

/// Unless the process handles SIGPIPE already, a write to a pipe without a reader fails with EPIPE from now
/// on. Programs that this process starts have the default again.
void surviveBrokenPipes();

}  // namespace naiad
