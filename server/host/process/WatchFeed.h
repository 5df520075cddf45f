// Passes events of the server on to those who watch it, from any thread.
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

#include "shared/net/base/TokenBucket.h"
#include "shared/program/LineLog.h"

namespace naiad {

struct WatchEvent {
  std::string kind;  ///< "log", "chat", "game"
  std::string text;
};

/// Thread-safe. Publishing never waits, and costs nothing while nobody watches.
class WatchFeed {
 public:
  /// Events that wait for the reader; further ones are dropped and counted.
  static constexpr std::size_t kMaxWaiting = 512;
  /// Lines of games: what a round's start may print, and in the long run. The others are left out and
  /// counted.
  static constexpr BucketRate kGameRate{100, 500};
  /// Bytes of such a line, at most.
  static constexpr std::size_t kMaxGameLine = 1000;

  /// `wake`: called, on the publisher's thread, when there is something to take after there was nothing.
  void begin(std::function<void()> wake);
  /// Nobody watches any more; `wake` is not called after this.
  void end();
  void publish(std::string kind, std::string text);
  /// A line that a game has written, which may have any bytes: control characters are escaped.
  void publishGame(const std::string& line, std::chrono::steady_clock::time_point now);

  /// The same logs, of which those who watch read every line: of the server's own, and of its game's. This
  /// outlives them.
  LogLine watched(LogLine log);
  LogLine watchedGame(LogLine log);

  struct Taken {
    std::vector<WatchEvent> events;
    std::uint64_t dropped = 0;
  };
  Taken take();

 private:
  void add(WatchEvent event);

  std::atomic<bool> m_watched = false;
  std::mutex m_mutex;
  std::function<void()> m_wake;
  Taken m_waiting;
  TokenBucket m_game_lines;
  std::uint64_t m_left_out = 0;  ///< lines of games, since the last one that was published
};

}  // namespace naiad
