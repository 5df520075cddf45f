// The log file of this process, for worlds that have no sink of their own.
#pragma once

#include <string>

namespace df {

/// Append a line to dragonfly.log in the working directory; the first call opens and empties it. Where that
/// cannot be done, the line is dropped. Any thread.
void writeToLogFile(const std::string& line, bool flush);

}  // namespace df
