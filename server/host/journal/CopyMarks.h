// Where in a round the copies of its world are (WorldPort::keepCopy), and when the next one is due.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

namespace naiad {

/// The world after a tick of which a copy was kept.
struct CopyMark {
  std::uint32_t ticks = 0;             ///< that it has had
  std::vector<std::uint32_t> players;  ///< that had joined and not left, in order
  std::size_t records = 0;             ///< bytes of the round's records up to there
};

class CopyMarks {
 public:
  /// Ticks between two copies: ten seconds of a usual game. A copy takes 0.4 to 1.5 ms of the world's time.
  static constexpr std::uint32_t kTicks = 300;
  /// Of the first one, by which most games have begun: until then a new world is as quick.
  static constexpr std::uint32_t kFirst = 30;
  /// Where ticks take long, so that the ticks since the newest copy are executed again in little time: then
  /// it is looked every so many ticks, and due when they have taken so much of a processor.
  static constexpr std::uint32_t kFewestTicks = 60;
  static constexpr std::chrono::milliseconds kLongest{100};

  /// In the tick that begins. `cpu_time` says how much of a processor the world's process has taken, and is
  /// called once in a while.
  template <class CpuTime>
  bool isDue(std::uint32_t ticks, CpuTime cpu_time) {
    if (m_asked == 0 ? ticks < kFirst : (ticks - m_asked) % kFewestTicks != 0) return false;
    return isDueNow(ticks, cpu_time());
  }
  /// One was asked for, for the tick that begins; `is_kept`: there will be one.
  void beginTick(std::uint32_t ticks, std::vector<std::uint32_t> players, bool is_kept);
  /// The tick has its result in the round's records. True: a copy was kept behind it.
  bool endTick(std::size_t records);
  /// The copy behind so many ticks goes on: it and those that are newer have no mark any more.
  std::optional<CopyMark> take(std::uint32_t ticks);
  void clear();

 private:
  bool isDueNow(std::uint32_t ticks, std::chrono::nanoseconds cpu_time);

  static constexpr std::size_t kMost = 8;  ///< more than a world keeps copies

  std::deque<CopyMark> m_marks;            ///< newest last
  std::optional<CopyMark> m_under_way;     ///< of the tick that has begun
  std::uint32_t m_asked = 0;               ///< in which tick; 0: never
  std::chrono::nanoseconds m_cpu_time{0};  ///< then
};

}  // namespace naiad
