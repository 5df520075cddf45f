// How an event of the log becomes a line.
#pragma once

#include <chrono>
#include <cstddef>
#include <string>

#include "shared/program/LogEvent.h"

namespace naiad {

enum class LogFormat {
  kText,  ///< "2026-01-31 13:59:59 sentence", in local time
  kBare,  ///< "sentence"
  kJson,  ///< {"time":"2026-01-31T12:59:59.123Z","level":"info","event":"note","text":"sentence",…}
};

/// The event as a line that ends with \n, of at most `max_bytes` (512 or more) bytes: sentences that are
/// longer are cut off. Control characters are escaped; JSON stays valid whatever the bytes are.
std::string formatEvent(const LogEvent& event, LogFormat format, std::chrono::system_clock::time_point time,
                        std::size_t max_bytes);

}  // namespace naiad
