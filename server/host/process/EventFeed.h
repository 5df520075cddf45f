// Passes events of the server to programs that watch it (`dfctl watch`), from any thread.
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

struct FeedEvent {
  std::string kind;  ///< "log", "chat", "game"
  std::string text;
};

/// Thread-safe. Publishing never waits, and costs nothing without watchers.
class EventFeed {
 public:
  /// Maximum number of events that wait for the reader; further ones are dropped and counted.
  static constexpr std::size_t kMaxWaiting = 512;
  /// Rate limit for lines of games: lines per second, and burst for the start of a round. Further lines are
  /// dropped and counted.
  static constexpr BucketRate kGameRate{100, 500};
  /// Maximum bytes of a game's line; the rest of it is dropped.
  static constexpr std::size_t kMaxGameLine = 1000;

  /// Starts the feed. `wake` is called, on the publisher's thread, when an event is added to the empty feed.
  void begin(std::function<void()> wake);
  /// Stops the feed; `wake` is not called after this.
  void end();
  void publish(std::string kind, std::string text);
  /// Publishes a line that a game has written, which may have any bytes: control characters are escaped.
  void publishGame(const std::string& line, std::chrono::steady_clock::time_point now);

  /// Return logs that also publish each line: the server's own, and its game's. This must outlive them.
  LogLine publishing(LogLine log);
  LogLine publishingGame(LogLine log);

  struct EventBatch {
    std::vector<FeedEvent> events;
    std::uint64_t dropped = 0;
  };
  EventBatch popAll();

 private:
  void add(FeedEvent event);

  std::atomic<bool> m_is_watched = false;
  std::mutex m_mutex;
  std::function<void()> m_wake;
  EventBatch m_waiting;
  TokenBucket m_game_lines;
  std::uint64_t m_dropped_game_lines = 0;  ///< dropped lines of games, since the last one that was published
};

}  // namespace naiad
