#include "client/world/InputTickEstimator.h"

#include <algorithm>
#include <cmath>

namespace naiad {

void InputTickEstimator::addRttSample(Millis sample) {
  m_round_trips[m_count++ % m_round_trips.size()] = sample;
}

InputTickEstimator::Millis InputTickEstimator::shortestRoundTrip() const {
  const auto end =
      m_round_trips.begin() + static_cast<std::ptrdiff_t>(std::min(m_count, m_round_trips.size()));
  const auto shortest = std::min_element(m_round_trips.begin(), end);
  return shortest != end ? *shortest : Millis{0};
}

void InputTickEstimator::onInputApplied(std::uint32_t asked, std::uint32_t taken) {
  const bool late = static_cast<std::int32_t>(taken - asked) > 0;
  m_margin = std::clamp(m_margin + (late ? kGrow : -kShrink), kMinMargin, kMaxMargin);
}

std::uint32_t InputTickEstimator::tickFor(const DisplayClock& clock, DisplayClock::Duration tick_length,
                                          Time now) const {
  const double way = shortestRoundTrip() / Millis(tick_length);
  const double ahead = std::max(clock.ticksSinceNewest(now), 0.0) + way + m_margin;
  return clock.newestTick() + static_cast<std::uint32_t>(std::floor(std::min(ahead, 60.0))) + 1;
}

}  // namespace naiad
