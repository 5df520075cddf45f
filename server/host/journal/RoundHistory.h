// The records of a round, for the world that takes over after a crash: all of them, or those since the oldest
// copy of the world (WorldProcess::requestCheckpoint). Also stores the positions of the copies, and decides
// when the next one is due.
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

/// Position of a copy in the round.
struct CheckpointMark {
  std::uint32_t ticks = 0;             ///< number of ticks before the copy
  std::vector<std::uint32_t> players;  ///< players in the world, in the order in which they joined
  std::size_t records = 0;             ///< bytes of RoundHistory::records() up to the copy
};

class RoundHistory {
 public:
  /// Maximum size of the records, in bytes: days of play. Of a longer round, only those since the oldest copy
  /// are kept.
  static constexpr std::size_t kMaxBytes = std::size_t{64} << 20;

  /// Ticks between two copies: ten seconds of a usual game. A copy takes 0.4 to 1.5 ms of the world's time.
  static constexpr std::uint32_t kCheckpointInterval = 300;
  /// Ticks before the first copy: most games have started up after them, and replaying so few ticks is fast.
  static constexpr std::uint32_t kFirstCheckpoint = 30;
  /// If ticks are slow, copies are made more often, so the ticks since the newest copy can be replayed fast:
  /// every kMinCheckpointInterval ticks a copy is due if the world has used kMaxReplayTime of processor time.
  static constexpr std::uint32_t kMinCheckpointInterval = 60;
  static constexpr std::chrono::milliseconds kMaxReplayTime{100};

  /// `records`: the records so far of a round that is resumed.
  explicit RoundHistory(std::string records = {}) : m_records(std::move(records)) {}

  /// Adds the next record. Returns false if the records would exceed kMaxBytes and there is no copy, so that
  /// none can be dropped; then nothing is kept.
  bool add(std::string_view record) {
    if (m_records.size() + record.size() > kMaxBytes && !dropOldRecords()) {
      *this = RoundHistory();
      return false;
    }
    m_records += record;
    return true;
  }
  const std::string& records() const { return m_records; }
  /// True if records() begins with the round. Otherwise only a copy can resume it, not a new world.
  bool hasBeginning() const { return m_has_beginning; }

  /// True if a copy is due in the tick that begins. `cpu_time` returns the processor time that the world's
  /// process has used; it is not called in every tick.
  template <class CpuTime>
  bool isCheckpointDue(std::uint32_t ticks, CpuTime cpu_time) {
    if (m_requested_tick == 0 ? ticks < kFirstCheckpoint
                              : (ticks - m_requested_tick) % kMinCheckpointInterval != 0)
      return false;
    return isDueNow(ticks, cpu_time());
  }
  /// Call when a copy was ordered for the tick that begins. `is_requested`: false if the order failed.
  void beginCheckpoint(std::uint32_t ticks, std::vector<std::uint32_t> players, bool is_requested) {
    m_requested_tick = ticks;
    if (is_requested) m_in_progress = CheckpointMark{ticks, std::move(players), 0};
  }
  /// Call when records() has the tick's result. Returns true if a copy was made after it.
  bool endTick() {
    if (!m_in_progress) return false;
    m_in_progress->records = m_records.size();
    m_marks.push_back(*std::exchange(m_in_progress, std::nullopt));
    if (m_marks.size() > kMaxMarks) m_marks.pop_front();
    if (!m_has_beginning) dropOldRecords();
    return true;
  }
  /// Returns the mark of the copy after `ticks` ticks, which takes over, or nullopt. Removes this mark and
  /// newer ones.
  std::optional<CheckpointMark> popCheckpoint(std::uint32_t ticks) {
    // The next copy is due soon, because one copy fewer is left.
    m_in_progress.reset();
    m_requested_tick = 0;
    while (!m_marks.empty() && m_marks.back().ticks > ticks) m_marks.pop_back();
    if (m_marks.empty() || m_marks.back().ticks != ticks) return std::nullopt;
    CheckpointMark mark = std::move(m_marks.back());
    m_marks.pop_back();
    return mark;
  }
  /// Removes all marks.
  void dropCheckpoints() {
    m_marks.clear();
    m_in_progress.reset();
    m_requested_tick = 0;
    m_cpu_time = {};
  }

 private:
  bool isDueNow(std::uint32_t ticks, std::chrono::nanoseconds cpu_time) {
    const bool is_due = m_requested_tick == 0 || ticks - m_requested_tick >= kCheckpointInterval ||
                        cpu_time - m_cpu_time >= kMaxReplayTime;
    if (is_due) m_cpu_time = cpu_time;
    return is_due;
  }
  bool dropOldRecords() {
    const std::size_t forgotten = m_marks.empty() ? 0 : m_marks.front().records;
    if (forgotten == 0) return false;
    for (CheckpointMark& mark : m_marks) mark.records -= forgotten;
    m_records.erase(0, forgotten);
    m_has_beginning = false;
    return true;
  }

  static constexpr std::size_t kMaxMarks = 8;  ///< maximum number of marks; a world keeps fewer copies

  std::string m_records;
  bool m_has_beginning = true;
  std::deque<CheckpointMark> m_marks;           ///< newest last
  std::optional<CheckpointMark> m_in_progress;  ///< mark of the copy ordered in this tick
  std::uint32_t m_requested_tick = 0;           ///< tick of the newest order for a copy; 0: none
  std::chrono::nanoseconds m_cpu_time{0};       ///< processor time of the world at that order
};

static_assert(RoundHistory::kCheckpointInterval % RoundHistory::kMinCheckpointInterval == 0,
              "isCheckpointDue() looks every kMinCheckpointInterval");

}  // namespace naiad
