// The log lines that clients cause, fewer than these could make them.
//
// Each begins with the client's address, which has finished a TCP handshake and so is the client's own. Names
// in them are quoted (LogText.h). What is over the limits is counted, and the count is a line.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include "shared/net/base/PerAddress.h"
#include "shared/net/base/TokenBucket.h"
#include "shared/program/LineLog.h"

namespace naiad {

/// Not thread-safe. Time is passed in.
class ClientLog {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// Of refusals: a second.
  static constexpr BucketRate kRefusalsOfAPrefix{1, 1};
  static constexpr BucketRate kRefusalsInAll{20, 20};
  /// Of the rest: players who join, leave and come back. A class joins and leaves at once.
  static constexpr BucketRate kNewsOfAPrefix{1, 128};
  static constexpr BucketRate kNewsInAll{20, 512};
  /// Between two lines with counts of one kind.
  static constexpr std::chrono::seconds kCountTime{10};

  explicit ClientLog(LogLine log);

  /// "ADDRESS TEXT", with the address among the facts. `address` is that of a TCP connection,
  /// "127.0.0.1:40000".
  void logNews(const std::string& address, LogEvent event, Time now);
  /// `ADDRESS refused: "SENTENCE"`, with the sentence among the facts.
  void logRefusal(const std::string& address, const std::string& sentence, Time now);
  /// Log the counts that are due. Once a tick.
  void update(Time now);
  /// Log them all: the server ends.
  void finish();

 private:
  struct Kind {
    const char* name;
    BucketRate of_a_prefix;
    BucketRate in_all;
    PerAddress<TokenBucket> prefixes;
    TokenBucket all{};
    std::uint64_t left_out = 0;
    Time counted_at{};
  };
  void log(Kind& kind, const std::string& address, LogEvent event, Time now);
  void logCount(Kind& kind);

  LogLine m_log;
  Kind m_news;
  Kind m_refusals;
};

}  // namespace naiad
