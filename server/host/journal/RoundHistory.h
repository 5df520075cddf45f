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
  bool add(std::string_view record) {
    if (m_records.size() + record.size() > kMaxBytes && !forgetBeginning()) {
      *this = RoundHistory();
      return false;
    }
    m_records += record;
    return true;
  }
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
  void beginCopy(std::uint32_t ticks, std::vector<std::uint32_t> players, bool is_kept) {
    m_asked = ticks;
    if (is_kept) m_under_way = CopyMark{ticks, std::move(players), 0};
  }
  /// The tick has its result in records(). True: a copy was kept behind it.
  bool endTick() {
    if (!m_under_way) return false;
    m_under_way->records = m_records.size();
    m_marks.push_back(*std::exchange(m_under_way, std::nullopt));
    if (m_marks.size() > kMost) m_marks.pop_front();
    if (!m_has_beginning) forgetBeginning();
    return true;
  }
  /// The copy behind so many ticks goes on: it and those that are newer have no mark any more.
  std::optional<CopyMark> takeCopy(std::uint32_t ticks) {
    // The next one is due soon: what goes on has one copy fewer.
    m_under_way.reset();
    m_asked = 0;
    while (!m_marks.empty() && m_marks.back().ticks > ticks) m_marks.pop_back();
    if (m_marks.empty() || m_marks.back().ticks != ticks) return std::nullopt;
    CopyMark mark = std::move(m_marks.back());
    m_marks.pop_back();
    return mark;
  }
  /// There are no copies any more.
  void dropCopies() {
    m_marks.clear();
    m_under_way.reset();
    m_asked = 0;
    m_cpu_time = {};
  }

 private:
  bool isDueNow(std::uint32_t ticks, std::chrono::nanoseconds cpu_time) {
    const bool is_due = m_asked == 0 || ticks - m_asked >= kTicks || cpu_time - m_cpu_time >= kLongest;
    if (is_due) m_cpu_time = cpu_time;
    return is_due;
  }
  bool forgetBeginning() {
    const std::size_t forgotten = m_marks.empty() ? 0 : m_marks.front().records;
    if (forgotten == 0) return false;
    for (CopyMark& mark : m_marks) mark.records -= forgotten;
    m_records.erase(0, forgotten);
    m_has_beginning = false;
    return true;
  }

  static constexpr std::size_t kMost = 8;  ///< more than a world keeps copies

  std::string m_records;
  bool m_has_beginning = true;
  std::deque<CopyMark> m_marks;            ///< newest last
  std::optional<CopyMark> m_under_way;     ///< of the tick that has begun
  std::uint32_t m_asked = 0;               ///< in which tick; 0: never
  std::chrono::nanoseconds m_cpu_time{0};  ///< then
};

static_assert(RoundHistory::kTicks % RoundHistory::kFewestTicks == 0, "that is when it is looked");

}  // namespace naiad
