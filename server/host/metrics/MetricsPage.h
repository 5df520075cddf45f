// The page that a scraper reads: /metrics.
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

/// What the kernel says of this process, as every exporter of Prometheus gives it out (process_…).
struct ProcessFacts {
  double cpu_seconds = 0;      ///< of all its threads, in the program and in the kernel
  double start_seconds = 0;    ///< since 1970
  std::uint64_t resident = 0;  ///< bytes
  std::uint64_t virtual_size = 0;
  std::uint64_t open_files = 0;
  std::uint64_t max_files = 0;

  /// Reads /proc; what cannot be read is 0.
  static ProcessFacts read();
};

/// Writes the families process_… of these facts.
void writeProcess(Exposition& out, const ProcessFacts& facts);

/// Upper bounds of buckets.
inline constexpr std::array<double, 10> kRoundTripBounds{0.001, 0.005, 0.01, 0.025, 0.05,
                                                         0.1,   0.2,   0.4,  0.8,   2};
inline constexpr std::array<double, 9> kLossBounds{0, 0.001, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5};

/// The values of all metrics of a host at one moment. The thread that ticks makes one once a second; it never
/// changes.
struct MetricsSnapshot {
  Counters counters;
  PasswordCheck::Counters passwords;
  NetworkCounters network;
  StageClock::Seconds stages{};
  Histogram tick_durations{kTickBounds};
  Histogram tick_lateness{kLatenessBounds};
  Histogram round_trips{kRoundTripBounds};  ///< one of each player that has a line, each second
  Histogram losses{kLossBounds};            ///< the same

  /// Of threads so far; "other" are those of passwords, log, watchdog, and the game's own.
  struct Cpu {
    std::chrono::nanoseconds tick{0};
    std::chrono::nanoseconds network{0};
    std::chrono::nanoseconds metrics{0};
    std::chrono::nanoseconds other{0};
  } cpu;

  // At this moment.
  std::uint64_t connected = 0;  ///< players
  std::uint64_t detached = 0;   ///< players whose connection broke
  std::uint64_t greeting = 0;   ///< connections that are no players yet
  std::uint64_t max_players = 0;
  std::uint64_t rooms = 0;
  std::uint64_t objects = 0;  ///< that are published
  double tick_length = 0;     ///< seconds
  /// A room that has a name.
  struct NamedRoom {
    std::string name;
    std::string game;
    std::uint64_t players = 0;
    std::uint64_t late_ticks = 0;
    bool asleep = false;
  };
  std::vector<NamedRoom> named_rooms;
};

/// In Prometheus' text format (Exposition.h). `snapshot` null: the host has none yet, and the page has only
/// what the process itself knows.
std::string renderMetrics(const MetricsSnapshot* p_snapshot, const ProcessFacts& process);

}  // namespace naiad
