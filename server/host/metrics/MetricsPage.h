// The page /metrics for Prometheus.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "host/auth/PasswordCheck.h"
#include "host/net/NetworkThread.h"
#include "host/process/StageClock.h"
#include "host/session/Counters.h"

namespace naiad {

class Exposition;

/// The kernel's data about this process: the standard process_* metrics of Prometheus.
struct ProcessInfo {
  double cpu_seconds = 0;      ///< user and system time of all threads
  double start_seconds = 0;    ///< seconds since 1970
  std::uint64_t resident = 0;  ///< bytes
  std::uint64_t virtual_size = 0;
  std::uint64_t open_files = 0;
  std::uint64_t max_files = 0;

  /// Reads /proc. Values that cannot be read are 0.
  static ProcessInfo read();
};

/// Writes the process_* metrics.
void writeProcess(Exposition& out, const ProcessInfo& facts);

/// Upper bounds of the buckets of round-trip times (in seconds) and of losses (0 … 1).
inline constexpr std::array<double, 10> kRoundTripBounds{0.001, 0.005, 0.01, 0.025, 0.05,
                                                         0.1,   0.2,   0.4,  0.8,   2};
inline constexpr std::array<double, 9> kLossBounds{0, 0.001, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5};

/// A host's metrics at one moment. The tick thread publishes one every second, which then never changes.
struct MetricsSnapshot {
  Counters counters;
  PasswordCheck::Counters passwords;
  NetworkCounters network;
  StageClock::Seconds stages{};
  Histogram tick_durations{kTickBounds};
  Histogram tick_lateness{kLatenessBounds};
  Histogram round_trips{kRoundTripBounds};  ///< one sample per second of each player with a known round trip
  Histogram losses{kLossBounds};            ///< one sample per second of each connected player

  /// CPU times of threads since the start. `other`: of all other threads, such as those for passwords and the
  /// log, and the game's own.
  struct Cpu {
    std::chrono::nanoseconds tick{0};
    std::chrono::nanoseconds network{0};
    std::chrono::nanoseconds metrics{0};
    std::chrono::nanoseconds other{0};
  } cpu;

  // Values at this moment.
  std::uint64_t connected = 0;  ///< players with a connection
  std::uint64_t detached = 0;   ///< players that lost the connection
  std::uint64_t greeting = 0;   ///< sessions that do not play yet, or not any more
  std::uint64_t max_players = 0;
  std::uint64_t rooms = 0;    ///< rooms that are not asleep
  std::uint64_t objects = 0;  ///< published Objects
  double tick_length = 0;     ///< seconds
  /// A named room.
  struct NamedRoom {
    std::string name;
    std::string game;
    std::uint64_t players = 0;
    std::uint64_t late_ticks = 0;
    bool asleep = false;
  };
  std::vector<NamedRoom> named_rooms;
};

/// Returns the page in Prometheus' text format (Exposition.h). Without a snapshot (null) it has only the
/// build and process metrics.
std::string renderMetrics(const MetricsSnapshot* p_snapshot, const ProcessInfo& process);

}  // namespace naiad
