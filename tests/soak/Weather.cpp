#include "Weather.h"

namespace naiad::soak {

namespace {

// Mean time in seconds between two events of a kind, if haste is 1.
constexpr double kRedraw = 60;
constexpr double kOutage = 300;
constexpr double kBlockade = 240;
constexpr double kRebind = 120;
constexpr double kBreak = 120;
constexpr double kKill = 900;
constexpr double kLeave = 900;

}  // namespace

Weather::Weather(std::uint64_t seed, double haste) : m_random(seed), m_haste(haste) {
  m_up = draw();
  m_down = draw();
}

Weather::Time Weather::between(int low_millis, int high_millis) {
  const auto range = static_cast<std::uint64_t>(high_millis - low_millis);
  return std::chrono::milliseconds(low_millis + static_cast<int>(m_random.below(range + 1)));
}

LinkConditions Weather::draw() {
  LinkConditions conditions;
  conditions.delay = between(25, 150);
  conditions.jitter = between(0, 40);
  conditions.reorder = m_random.below(4) != 0;
  conditions.loss = 0.02 + 0.18 * m_random.unit();
  conditions.duplicate = m_random.below(2) == 0 ? 0.05 * m_random.unit() : 0;
  if (m_random.below(10) == 0) {
    conditions.rate = 6'000 + m_random.below(14'000);
    conditions.queue = 8'192;
  }
  return conditions;
}

Strokes Weather::tick(Time now) {
  Strokes strokes;
  if (m_fine) return strokes;
  if (strikes(kRedraw)) {
    m_up = draw();
    m_down = draw();
    strokes.changed = true;
  }
  if (m_outage_until && now >= *m_outage_until) {
    m_outage_until.reset();
    strokes.changed = strokes.healed = true;
  } else if (!m_outage_until && strikes(kOutage)) {
    m_outage_until = now + between(500, 30'000);
    ++m_outages;
    strokes.changed = true;
  }
  if (m_block_until && now >= *m_block_until) {
    m_block_until.reset();
    strokes.changed = strokes.healed = true;
  } else if (!m_block_until && strikes(kBlockade)) {
    m_block_until = now + between(3'000, 40'000);
    m_block_kind = static_cast<int>(m_random.below(3));
    ++m_blockades;
    strokes.changed = strokes.healed = true;
  }
  strokes.rebind = strikes(kRebind);
  strokes.break_stream = strikes(kBreak);
  strokes.kill = strikes(kKill);
  strokes.leave = strikes(kLeave);
  return strokes;
}

void Weather::heal() {
  m_fine = true;
  m_outage_until.reset();
  m_block_until.reset();
  m_up = m_down = LinkConditions{};
  m_up.delay = m_down.delay = std::chrono::milliseconds(40);
}

LinkConditions Weather::of(LinkConditions conditions) const {
  if (m_outage_until) conditions.loss = 1;
  return conditions;
}

LinkConditions Weather::ofStream(LinkConditions conditions) const {
  conditions.loss /= 10;
  return of(conditions);
}

}  // namespace naiad::soak
