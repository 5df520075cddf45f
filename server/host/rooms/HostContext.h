// The state that all parts of a host share: its options, log, counters, and the event queue of its thread.
#pragma once

#include <asio/io_context.hpp>
#include <string>
#include <utility>

#include "host/process/EventFeed.h"
#include "host/process/ShutdownScheduler.h"
#include "host/process/StageClock.h"
#include "host/session/Counters.h"
#include "host/settings/HostOptions.h"
#include "shared/program/ClientLog.h"
#include "shared/program/LineLog.h"

namespace naiad {

// A worker thread's message as a log event.

/// Returns an event of level warning if the message begins with "warning: ", else of level info.
inline LogEvent workerLogEvent(const std::string& news) {
  return {news.starts_with("warning: ") ? LogEvent::Level::kWarning : LogEvent::Level::kInfo, news};
}

/// Not thread-safe, except for `feed`, `log` and the atomics of `stages`.
struct HostContext {
  HostContext(HostOptions in_force, std::string game_name, LogLine log_line)
      : options(std::move(in_force)), game(std::move(game_name)), log(feed.publishing(std::move(log_line))) {}

  HostOptions options;     ///< current values; some change while the server runs
  const std::string game;  ///< name of the game; with several rooms, of the first room's game
  EventFeed feed;
  const LogLine log;  ///< also sends its lines to watchers of `feed`
  ClientLog client_log{log};
  Counters counters;
  asio::io_context home{1};  ///< runs the handlers of the host's thread; no clients' sockets
  StageClock stages;
  ShutdownScheduler shutdown_scheduler;
};

}  // namespace naiad
