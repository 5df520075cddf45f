// A rate limit for log lines that clients cause.
//
// Each line begins with the client's address, which is genuine because TCP's handshake is done. Names in the
// lines are quoted (LogText.h). Lines over the limits are counted, and the count is logged.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include "shared/net/base/PrefixLruMap.h"
#include "shared/net/base/TokenBucket.h"
#include "shared/program/LineLog.h"

namespace naiad {

/// Not thread-safe. Time is passed in.
class ClientLog {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// Limits of refusals that are logged: rate per second and burst, per address prefix and in all.
  static constexpr BucketRate kRefusalRatePerPrefix{1, 1};
  static constexpr BucketRate kTotalRefusalRate{20, 20};
  /// Limits of other lines: players join, leave and return. A whole school class may join and leave at once.
  static constexpr BucketRate kEventRatePerPrefix{1, 128};
  static constexpr BucketRate kTotalEventRate{20, 512};
  /// Interval between two lines with the count of dropped lines of one kind.
  static constexpr std::chrono::seconds kCountInterval{10};

  explicit ClientLog(LogLine log);

  /// Logs "ADDRESS TEXT"; the address also becomes a field. `address` is the other end of a TCP connection,
  /// like "127.0.0.1:40000".
  void logClientEvent(const std::string& address, LogEvent event, Time now);
  /// Logs `ADDRESS refused: "SENTENCE"`; the sentence also becomes a field.
  void logRefusal(const std::string& address, const std::string& sentence, Time now);
  /// Logs the counts of dropped lines that are due. Call once per tick.
  void update(Time now);
  /// Logs all counts of dropped lines. Call when the server ends.
  void finish();

 private:
  struct Kind {
    const char* name;
    BucketRate per_prefix;
    BucketRate total;
    PrefixLruMap<TokenBucket> prefixes;
    TokenBucket all{};
    std::uint64_t suppressed = 0;
    Time counted_at{};
  };
  void log(Kind& kind, const std::string& address, LogEvent event, Time now);
  void logCount(Kind& kind);

  LogLine m_log;
  Kind m_events;
  Kind m_refusals;
};

}  // namespace naiad
