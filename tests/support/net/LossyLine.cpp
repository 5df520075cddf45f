#include "tests/support/net/LossyLine.h"

#include <algorithm>

namespace naiad {

using std::chrono::nanoseconds;

LossyLine::Fate LossyLine::send(Time now, std::size_t size) {
  Fate fate{.number = ++counters_.sent};
  // Always draw four times, so that a different loss rate does not change the fate of other packets.
  const bool lost = rng_.unit() < conditions_.loss;
  const bool twice = rng_.unit() < conditions_.duplicate;
  const Time first = conditions_.delay + jitter();
  const Time second = conditions_.delay + jitter();

  Time departure;
  if (!leave(now, size, departure) || lost) {
    ++counters_.dropped;
    return fate;
  }
  fate.arrivals[0] = arrival(departure + first);
  fate.copies = 1;
  if (!twice) return fate;
  ++counters_.duplicated;
  fate.arrivals[1] = arrival(departure + second);
  fate.copies = 2;
  return fate;
}

void LossyLine::delivered(std::uint64_t number) {
  ++counters_.delivered;
  if (number < newest_delivered_) ++counters_.reordered;
  newest_delivered_ = std::max(newest_delivered_, number);
}

LossyLine::Time LossyLine::jitter() {
  const auto range = std::max<Time::rep>(conditions_.jitter.count(), 0);
  return Time(static_cast<Time::rep>(rng_.below(static_cast<std::uint64_t>(range) + 1)));
}

/// Computes when the last byte leaves. False if the queue in front of the line is full.
bool LossyLine::leave(Time now, std::size_t size, Time& departure) {
  departure = now;
  if (conditions_.rate == 0) return true;
  const nanoseconds start = std::max<nanoseconds>(now, line_free_);
  const double waiting =
      std::chrono::duration<double>(start - now).count() * static_cast<double>(conditions_.rate);
  if (waiting + static_cast<double>(size) > static_cast<double>(conditions_.queue)) return false;
  line_free_ = start + nanoseconds(size * 1'000'000'000 / conditions_.rate);
  departure = std::chrono::ceil<Time>(line_free_);
  return true;
}

LossyLine::Time LossyLine::arrival(Time when) {
  if (!conditions_.reorder) when = std::max(when, last_arrival_);
  last_arrival_ = std::max(when, last_arrival_);
  return when;
}

}  // namespace naiad
