// Time that a test advances.
//
// Everything that happens in virtual time is an action in one queue. Advancing the clock runs what became
// due, in time order and, for equal times, in the order in which it was scheduled, so a run is the same
// every time and takes no longer than its computation.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

namespace naiad {

/// Not thread-safe. Must outlive the links and whatever else schedules on it.
class VirtualClock {
 public:
  using Time = std::chrono::microseconds;
  using Action = std::function<void()>;

  /// Time since the clock was made.
  Time now() const { return now_; }

  /// Run `action` at `when`, or at the next advance if that is past. Never runs it from inside this call.
  void schedule(Time when, Action action);

  /// Move to `time` (not before now), running every action due up to and including it. During an action,
  /// now() is the time the action was scheduled for; actions may schedule more, which run too if due.
  /// Throws std::logic_error when called from an action or with a time that is past.
  void advanceTo(Time time);
  void advanceBy(Time duration) { advanceTo(now_ + duration); }

  /// When the next action is due; nothing if none is scheduled.
  std::optional<Time> nextDue() const;

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
  std::vector<Entry> queue_;  // a heap, the earliest first
};

}  // namespace naiad
