// A clock that a test advances.
//
// Everything that happens in virtual time is an action in one queue. Advancing the clock runs the due actions
// by time, those of equal time in the order of their scheduling. So every run is equal and takes no longer
// than its computation.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <vector>

namespace naiad {

/// Not thread-safe. Must outlive the links and all else that schedules actions on it.
class VirtualClock {
 public:
  using Time = std::chrono::microseconds;
  using Action = std::function<void()>;

  /// Returns the time since the clock was made.
  Time now() const { return now_; }

  /// Schedules `action` for `when`, or for the next advance if that is past. Never runs it within this call.
  void schedule(Time when, Action action);

  /// Advances to `time` (not before now) and runs every action due up to and including it. During an action,
  /// now() is the time for which it was scheduled. Actions may schedule more, which also run if due. Throws
  /// std::logic_error when called from an action or with a time that is past.
  void advanceTo(Time time);
  void advanceBy(Time duration) { advanceTo(now_ + duration); }

 private:
  struct Entry {
    Time when;
    std::uint64_t order;
    Action action;
  };
  static bool later(const Entry& a, const Entry& b);

  Time now_{0};
  std::uint64_t scheduled_ = 0;
  bool running_ = false;
  std::vector<Entry> queue_;  // a heap, earliest first
};

}  // namespace naiad
