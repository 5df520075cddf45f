// Where the tick thread's time goes: seconds by stage of the tick, and the stage that it is in.
//
// A stage ends where the next one begins, so each change costs one reading of the clock. A clock that is off
// reads none.
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>

namespace naiad {

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

/// As in the metric's label: "between", "receive", ….
const char* nameOf(Stage stage);

/// enter() and seconds() are for the thread that ticks, current() for any.
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
  Stage current() const { return m_current.load(std::memory_order_relaxed); }

  using Seconds = std::array<std::chrono::nanoseconds, kStages>;
  /// By stage, until the last enter().
  const Seconds& spent() const { return m_spent; }

 private:
  bool m_on = false;
  std::atomic<Stage> m_current = Stage::kBetween;
  Clock::time_point m_since{};
  Seconds m_spent{};
};

}  // namespace naiad
