// Passes the output of a world, which includes the game's log lines, to the server's log.
//
// A world has the writing end of a pipe as its standard output and error, and no access to the log file. So
// it can add lines, each marked as the game's, and cannot change older ones. Lines above the rate are dropped
// and counted; a world that prints faster than update() reads must wait.
#pragma once

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <utility>

#include "shared/net/base/TokenBucket.h"

namespace naiad {

/// Not thread-safe.
class OutputRelay {
 public:
  using Clock = std::chrono::steady_clock;
  using Line = std::function<void(const std::string& line)>;

  /// Rate limit: lines per second, and burst for the start of a round.
  static constexpr BucketRate kRate{100, 500};
  /// Maximum bytes of a line; the rest of it is dropped.
  static constexpr std::size_t kMaxLine = 1000;
  /// After this many bytes an update() stops; its last read may exceed them by less than 16 KiB.
  static constexpr std::size_t kMaxRead = std::size_t{128} << 10;

  /// Takes over a pipe's non-blocking reading end; below 0: none. If `line` is empty, drops all lines.
  OutputRelay(int pipe, Line line) : m_pipe(pipe), m_line(std::move(line)) {}
  ~OutputRelay() {
    if (m_pipe >= 0) ::close(m_pipe);
  }
  OutputRelay(const OutputRelay&) = delete;
  OutputRelay& operator=(const OutputRelay&) = delete;

  /// Passes on the lines that the world has printed so far. Call once in each tick; never waits.
  void update(Clock::time_point now) {
    char piece[16 << 10];
    for (std::size_t done = 0; done < kMaxRead && m_pipe >= 0;) {
      const ssize_t got = ::read(m_pipe, piece, sizeof piece);
      if (got < 0 && errno == EINTR) continue;
      if (got <= 0) return;
      handlePiece({piece, static_cast<std::size_t>(got)}, now);
      done += static_cast<std::size_t>(got);
    }
  }
  /// Like update(), for a world that has ended: also passes on an unfinished line, and reports dropped lines.
  void finish(Clock::time_point now) {
    update(now);
    if (!m_text.empty()) endLine(now);
    reportDropped();
  }

 private:
  void handlePiece(std::string_view piece, Clock::time_point now) {
    while (!piece.empty()) {
      const std::size_t end = std::min(piece.find('\n'), piece.size());
      m_text += piece.substr(0, end).substr(0, kMaxLine - std::min(m_text.size(), kMaxLine));
      if (end == piece.size()) return;
      endLine(now);
      piece.remove_prefix(end + 1);
    }
  }
  void endLine(Clock::time_point now) {
    const std::string line = std::exchange(m_text, {});
    if (!m_bucket.tryConsume(kRate, now)) {
      ++m_dropped;
      return;
    }
    reportDropped();
    if (m_line) m_line(line);
  }
  void reportDropped() {
    const std::uint64_t dropped = std::exchange(m_dropped, 0);
    if (dropped > 0 && m_line) m_line(std::to_string(dropped) + " lines dropped (too many at once)");
  }

  int m_pipe;
  Line m_line;
  std::string m_text;  ///< the incomplete last line
  TokenBucket m_bucket;
  std::uint64_t m_dropped = 0;  ///< lines dropped since the last one that was passed on
};

}  // namespace naiad
