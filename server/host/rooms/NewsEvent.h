// News of a worker as an event of the log.
#pragma once

#include <string>

#include "shared/program/LineLog.h"

namespace naiad {

/// What begins with "warning: " is one.
inline LogEvent newsEvent(const std::string& news) {
  return {news.starts_with("warning: ") ? LogEvent::Level::kWarning : LogEvent::Level::kInfo, news};
}

}  // namespace naiad
