// Passes events of the server on to those who watch it, from any thread.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

namespace naiad {

struct WatchEvent {
  std::string kind;  ///< "log", "chat"
  std::string text;
};

/// Thread-safe. Publishing never waits, and costs nothing while nobody watches.
class WatchFeed {
 public:
  /// Events that wait for the reader; further ones are dropped and counted.
  static constexpr std::size_t kMaxWaiting = 512;

  /// `wake`: called, on the publisher's thread, when there is something to take after there was nothing.
  void begin(std::function<void()> wake);
  /// Nobody watches any more; `wake` is not called after this.
  void end();
  void publish(std::string kind, std::string text);

  struct Taken {
    std::vector<WatchEvent> events;
    std::uint64_t dropped = 0;
  };
  Taken take();

 private:
  std::atomic<bool> m_watched = false;
  std::mutex m_mutex;
  std::function<void()> m_wake;
  Taken m_waiting;
};

}  // namespace naiad
