// What all of a host works with: its options, its log, its counters, and the queue of its thread.
#pragma once

#include <asio/io_context.hpp>
#include <string>
#include <utility>

#include "host/process/Ending.h"
#include "host/process/StageClock.h"
#include "host/process/WatchFeed.h"
#include "host/session/Counters.h"
#include "host/settings/HostOptions.h"
#include "shared/program/ClientLog.h"
#include "shared/program/LineLog.h"

namespace naiad {

// News of a worker as an event of the log.

/// What begins with "warning: " is one.
inline LogEvent newsEvent(const std::string& news) {
  return {news.starts_with("warning: ") ? LogEvent::Level::kWarning : LogEvent::Level::kInfo, news};
}

/// Not thread-safe, but for `feed`, `log` and the atomics of `stages`.
struct HostContext {
  HostContext(HostOptions in_force, std::string game_name, LogLine log_line)
      : options(std::move(in_force)), game(std::move(game_name)), log(feed.watched(std::move(log_line))) {}

  HostOptions options;     ///< in force; some change while the server runs
  const std::string game;  ///< that is played; of several rooms the first one's
  WatchFeed feed;
  const LogLine log;  ///< watchers of `feed` read it, too
  ClientLog client_log{log};
  Counters counters;
  asio::io_context home{1};  ///< runs the handlers of the host's thread; no sockets
  StageClock stages;
  Ending ending;
};

}  // namespace naiad
