// Where the tick thread's time goes: seconds by stage of the tick, the stage that it is in, and how late
// ticks begin and how long they take.
//
// A stage ends where the next one begins, so each change costs one reading of the clock. A clock that is off
// reads none.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>

namespace naiad {

/// Counts of values by fixed upper bounds, as Prometheus' histograms have them.
/// Not thread-safe. A value costs a search among at most kMaxBounds bounds and one increment.
class Histogram {
 public:
  static constexpr std::size_t kMaxBounds = 16;

  /// `bounds`: the highest value of each bucket, rising, at most kMaxBounds; they outlive the histogram.
  explicit Histogram(std::span<const double> bounds)
      : m_bounds(bounds.first(std::min(bounds.size(), kMaxBounds))) {}

  /// A value that is over all bounds is counted beyond the last.
  void add(double value) {
    const auto found = std::lower_bound(m_bounds.begin(), m_bounds.end(), value);
    ++m_counts[static_cast<std::size_t>(found - m_bounds.begin())];
    m_sum += value;
  }

  std::span<const double> bounds() const { return m_bounds; }
  /// Values in the bucket of this bound alone; `bucket` == bounds().size(): beyond the last.
  std::uint64_t count(std::size_t bucket) const { return m_counts[bucket]; }
  double sum() const { return m_sum; }

 private:
  std::span<const double> m_bounds;
  std::array<std::uint64_t, kMaxBounds + 1> m_counts{};
  double m_sum = 0;
};

enum class Stage : std::uint8_t {
  kBetween,    ///< between two ticks: streams are served, or there is nothing to do
  kReceive,    ///< datagrams since the last tick
  kSessions,   ///< deadlines of sessions, rounds that end and begin
  kInputs,     ///< keys and clicks go into the worlds
  kWorld,      ///< the game's code and the engine; asking, for worlds in processes of their own
  kPublish,    ///< published models are compared with the world
  kSnapshots,  ///< snapshots are written, for each player
  kNews,       ///< sounds, lists of players, lines
  kFlush,      ///< all that is handed to the network thread
};
inline constexpr std::size_t kStages = 9;

/// Upper bounds of buckets, in seconds. A tick is 33 ms by default, and the late ones are of interest.
inline constexpr std::array<double, 14> kTickBounds{0.0001, 0.00025, 0.0005, 0.001, 0.0025, 0.005, 0.01,
                                                    0.02,   0.033,   0.05,   0.1,   0.25,   0.5,   1};
inline constexpr std::array<double, 11> kLatenessBounds{0.0001, 0.00025, 0.0005, 0.001, 0.0025, 0.005,
                                                        0.01,   0.033,   0.1,    0.5,   1};

/// current(), tick() and tickBegan() are for any thread, all else for the one that ticks.
class StageClock {
 public:
  using Clock = std::chrono::steady_clock;

  /// Begin to measure.
  void start() {
    m_on = true;
    m_since = Clock::now();
  }
  /// From now on it is this stage. Return the one before.
  Stage enter(Stage stage) {
    if (!m_on) return Stage::kBetween;
    const Stage before = m_current.load(std::memory_order_relaxed);
    const Clock::time_point now = Clock::now();
    m_spent[static_cast<std::size_t>(before)] += now - m_since;
    m_since = now;
    m_current.store(stage, std::memory_order_relaxed);
    return before;
  }
  /// A tick begins that was due at `deadline`.
  void beginTick(std::uint64_t number, Clock::time_point deadline, Clock::time_point now) {
    if (!m_on) return;
    m_tick.store(number, std::memory_order_relaxed);
    m_began.store(now.time_since_epoch().count(), std::memory_order_relaxed);
    m_lateness.add(std::chrono::duration<double>(now - deadline).count());
    m_in_tick = true;
  }
  /// All that the tick has sent is with the network thread. Further calls for one tick are ignored.
  void endTick() {
    if (!m_in_tick) return;
    m_in_tick = false;
    m_durations.add(std::chrono::duration<double>(Clock::now() - tickBegan()).count());
  }
  /// The newest tick; 0: none has begun.
  std::uint64_t tick() const { return m_tick.load(std::memory_order_relaxed); }
  Clock::time_point tickBegan() const {
    return Clock::time_point(Clock::duration(m_began.load(std::memory_order_relaxed)));
  }
  const Histogram& lateness() const { return m_lateness; }
  const Histogram& durations() const { return m_durations; }

  Stage current() const { return m_current.load(std::memory_order_relaxed); }

  using Seconds = std::array<std::chrono::nanoseconds, kStages>;
  /// By stage, until the last enter().
  const Seconds& spent() const { return m_spent; }

 private:
  bool m_on = false;
  bool m_in_tick = false;
  std::atomic<Stage> m_current = Stage::kBetween;
  Clock::time_point m_since{};
  Seconds m_spent{};
  std::atomic<std::uint64_t> m_tick = 0;
  std::atomic<Clock::rep> m_began = 0;
  Histogram m_lateness{kLatenessBounds};
  Histogram m_durations{kTickBounds};
};

}  // namespace naiad
