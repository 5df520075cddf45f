#include "client/world/DisplayClock.h"

namespace naiad {
namespace {

std::int32_t distance(std::uint32_t from, std::uint32_t to) {
  return static_cast<std::int32_t>(to - from);
}

}  // namespace

DisplayClock::Duration DisplayClock::due(std::uint32_t tick) const {
  return m_length * distance(m_anchor, tick);
}

void DisplayClock::onSnapshot(std::uint32_t tick, Time now) {
  m_last_arrival = now;
  if (!m_started) {
    m_started = true;
    m_newest = m_shown = m_anchor = tick;
    m_anchor_time = now;
    return;
  }
  if (distance(m_newest, tick) <= 0) return;  // a late snapshot, or another part of the newest tick
  m_newest = tick;
  Time expected = m_anchor_time + due(tick);
  const Duration late = now - expected;
  // Correct fully if early, or over a second late (the server paused or jumped); other delays may be jitter.
  if (late < Duration::zero() || late > std::chrono::seconds(1)) {
    expected = now;
  } else {
    expected += late / 16;
  }
  m_anchor = tick;
  m_anchor_time = expected;
}

std::uint32_t DisplayClock::displayTick(Time now) {
  if (!m_started) return 0;
  const auto allowed = static_cast<std::int32_t>(kMaxAhead / m_length);
  const auto elapsed = std::max<Duration>(now - m_anchor_time + m_lead, Duration::zero());
  const auto ahead = static_cast<std::int32_t>(std::min<std::int64_t>(elapsed / m_length, allowed));
  const std::uint32_t wanted = m_newest + static_cast<std::uint32_t>(ahead);
  const std::int32_t step = distance(m_shown, wanted);
  // Goes backwards only if the last tick shown is further ahead than allowed.
  const bool too_far_ahead = distance(m_newest, m_shown) > allowed;
  if (step > 0 || too_far_ahead) m_shown = wanted;
  return m_shown;
}

double DisplayClock::ticksSinceNewest(Time now) const {
  using Millis = std::chrono::duration<double, std::milli>;
  return m_started ? std::min(Millis(now - m_anchor_time), Millis(kMaxAhead)) / Millis(m_length) : 0;
}

DisplayClock::Time DisplayClock::nextTick(Time now) const {
  if (!m_started) return now + m_length;
  const auto ticks = std::max<std::int64_t>((now - m_anchor_time + m_lead) / m_length, 0) + 1;
  return m_anchor_time - m_lead + ticks * m_length;
}

}  // namespace naiad
