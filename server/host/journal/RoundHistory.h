// The records of a round, for another world that takes over: all, or those since the oldest copy of its world
// (WorldProcess::keepCopy). And where in them the copies are, and when the next one is due.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace naiad {

/// The world after a tick of which a copy was kept.
struct CopyMark {
  std::uint32_t ticks = 0;             ///< that it has had
  std::vector<std::uint32_t> players;  ///< that had joined and not left, in order
  std::size_t records = 0;             ///< bytes of RoundHistory::records() up to there
};

class RoundHistory {
 public:
  /// Bytes that are kept: days. Of a longer round those since the oldest copy are.
  static constexpr std::size_t kMaxBytes = std::size_t{64} << 20;

  /// Ticks between two copies: ten seconds of a usual game. A copy takes 0.4 to 1.5 ms of the world's time.
  static constexpr std::uint32_t kTicks = 300;
  /// Of the first one, by which most games have begun: until then a new world is as quick.
  static constexpr std::uint32_t kFirst = 30;
  /// Where ticks take long, so that the ticks since the newest copy are executed again in little time: then
  /// it is looked every so many ticks, and due when they have taken so much of a processor.
  static constexpr std::uint32_t kFewestTicks = 60;
  static constexpr std::chrono::milliseconds kLongest{100};

  /// `records`: of a round that goes on.
  explicit RoundHistory(std::string records = {}) : m_records(std::move(records)) {}

  /// The next record. False: the round is too long, and nothing of it is kept.
  bool add(std::string_view record);
  const std::string& records() const { return m_records; }
  /// records() begin with the round; otherwise no world can begin it again, but a copy can go on with it.
  bool hasBeginning() const { return m_has_beginning; }

  /// In the tick that begins. `cpu_time` says how much of a processor the world's process has taken, and is
  /// called once in a while.
  template <class CpuTime>
  bool isCopyDue(std::uint32_t ticks, CpuTime cpu_time) {
    if (m_asked == 0 ? ticks < kFirst : (ticks - m_asked) % kFewestTicks != 0) return false;
    return isDueNow(ticks, cpu_time());
  }
  /// A copy was asked for, for the tick that begins; `is_kept`: there will be one.
  void beginCopy(std::uint32_t ticks, std::vector<std::uint32_t> players, bool is_kept);
  /// The tick has its result in records(). True: a copy was kept behind it.
  bool endTick();
  /// The copy behind so many ticks goes on: it and those that are newer have no mark any more.
  std::optional<CopyMark> takeCopy(std::uint32_t ticks);
  /// There are no copies any more.
  void dropCopies();

 private:
  bool isDueNow(std::uint32_t ticks, std::chrono::nanoseconds cpu_time);
  bool forgetBeginning();

  static constexpr std::size_t kMost = 8;  ///< more than a world keeps copies

  std::string m_records;
  bool m_has_beginning = true;
  std::deque<CopyMark> m_marks;            ///< newest last
  std::optional<CopyMark> m_under_way;     ///< of the tick that has begun
  std::uint32_t m_asked = 0;               ///< in which tick; 0: never
  std::chrono::nanoseconds m_cpu_time{0};  ///< then
};

}  // namespace naiad
