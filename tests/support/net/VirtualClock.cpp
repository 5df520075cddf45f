#include "tests/support/net/VirtualClock.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace naiad {

bool VirtualClock::later(const Entry& a, const Entry& b) {
  return a.when != b.when ? a.when > b.when : a.order > b.order;
}

void VirtualClock::schedule(Time when, Action action) {
  queue_.push_back({std::max(when, now_), scheduled_++, std::move(action)});
  std::push_heap(queue_.begin(), queue_.end(), later);
}

void VirtualClock::advanceTo(Time time) {
  if (running_) throw std::logic_error("VirtualClock advanced from one of its actions");
  if (time < now_) throw std::logic_error("VirtualClock cannot go back");
  struct Running {  // restores the flag even if an action throws, so that a failing test does not fail twice
    bool& flag;
    ~Running() { flag = false; }
  } running{running_ = true};
  while (!queue_.empty() && queue_.front().when <= time) {
    std::pop_heap(queue_.begin(), queue_.end(), later);
    Entry entry = std::move(queue_.back());
    queue_.pop_back();
    now_ = entry.when;
    entry.action();
  }
  now_ = time;
}

}  // namespace naiad
