// Measures the tick thread's time by stage of the tick, and how late ticks begin and how long they take.
//
// A stage ends where the next begins, so each change reads the clock once. It is never read before start().
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>

namespace naiad {

/// Counts of values by fixed upper bounds, like Prometheus' histograms. Not thread-safe. A value costs a
/// search among at most kMaxBounds bounds and one increment.
class Histogram {
 public:
  static constexpr std::size_t kMaxBounds = 16;

  /// `bounds`: the highest values of the buckets, ascending, at most kMaxBounds; must outlive the histogram.
  explicit Histogram(std::span<const double> bounds)
      : m_bounds(bounds.first(std::min(bounds.size(), kMaxBounds))) {}

  /// Adds a value. A value above all bounds is counted in an extra bucket.
  void add(double value) {
    const auto found = std::lower_bound(m_bounds.begin(), m_bounds.end(), value);
    ++m_counts[static_cast<std::size_t>(found - m_bounds.begin())];
    m_sum += value;
  }

  std::span<const double> bounds() const { return m_bounds; }
  /// Returns the number of values in this bucket alone; `bucket` == bounds().size(): above all bounds.
  std::uint64_t count(std::size_t bucket) const { return m_counts[bucket]; }
  double sum() const { return m_sum; }

 private:
  std::span<const double> m_bounds;
  std::array<std::uint64_t, kMaxBounds + 1> m_counts{};
  double m_sum = 0;
};

enum class Stage : std::uint8_t {
  kIdle,        ///< between two ticks: serving streams, or idle
  kReceive,     ///< reading the datagrams since the last tick
  kSessions,    ///< deadlines of sessions; ends and starts of rounds
  kInputs,      ///< passing keys and clicks to the worlds
  kWorld,       ///< the game's code and the engine; for worlds in processes, only sending the turn
  kPublish,     ///< comparing published models with the world
  kSnapshots,   ///< writing snapshots for each player
  kBroadcasts,  ///< sending sounds, lists of players, and lines
  kFlush,       ///< handing everything to the network thread
};
inline constexpr std::size_t kStages = 9;

/// Upper bounds of the buckets of tick times, in seconds. One is about the default tick, 1/30 s.
inline constexpr std::array<double, 14> kTickBounds{0.0001, 0.00025, 0.0005, 0.001, 0.0025, 0.005, 0.01,
                                                    0.02,   0.033,   0.05,   0.1,   0.25,   0.5,   1};
inline constexpr std::array<double, 11> kLatenessBounds{0.0001, 0.00025, 0.0005, 0.001, 0.0025, 0.005,
                                                        0.01,   0.033,   0.1,    0.5,   1};

/// Any thread may call current(), tick() and tickBegan(); only the thread that ticks may call the others.
class StageClock {
 public:
  using Clock = std::chrono::steady_clock;

  /// Starts to measure.
  void start() {
    m_on = true;
    m_since = Clock::now();
  }
  /// Enters a stage. Returns the previous one.
  Stage enter(Stage stage) {
    if (!m_on) return Stage::kIdle;
    const Stage before = m_current.load(std::memory_order_relaxed);
    const Clock::time_point now = Clock::now();
    m_spent[static_cast<std::size_t>(before)] += now - m_since;
    m_since = now;
    m_current.store(stage, std::memory_order_relaxed);
    return before;
  }
  /// Begins a tick that was due at `deadline`.
  void beginTick(std::uint64_t number, Clock::time_point deadline, Clock::time_point now) {
    if (!m_on) return;
    m_tick.store(number, std::memory_order_relaxed);
    m_began.store(now.time_since_epoch().count(), std::memory_order_relaxed);
    m_lateness.add(std::chrono::duration<double>(now - deadline).count());
    m_in_tick = true;
  }
  /// Ends the tick: the network thread has all that it sent. Later calls for the tick are ignored.
  void endTick() {
    if (!m_in_tick) return;
    m_in_tick = false;
    m_durations.add(std::chrono::duration<double>(Clock::now() - tickBegan()).count());
  }
  /// Returns the number of the newest tick; 0: none has begun.
  std::uint64_t tick() const { return m_tick.load(std::memory_order_relaxed); }
  Clock::time_point tickBegan() const {
    return Clock::time_point(Clock::duration(m_began.load(std::memory_order_relaxed)));
  }
  const Histogram& lateness() const { return m_lateness; }
  const Histogram& durations() const { return m_durations; }

  Stage current() const { return m_current.load(std::memory_order_relaxed); }

  using Seconds = std::array<std::chrono::nanoseconds, kStages>;
  /// Returns the time by stage, until the last enter().
  const Seconds& spent() const { return m_spent; }

 private:
  bool m_on = false;
  bool m_in_tick = false;
  std::atomic<Stage> m_current = Stage::kIdle;
  Clock::time_point m_since{};
  Seconds m_spent{};
  std::atomic<std::uint64_t> m_tick = 0;
  std::atomic<Clock::rep> m_began = 0;
  Histogram m_lateness{kLatenessBounds};
  Histogram m_durations{kTickBounds};
};

}  // namespace naiad
