#include "engine/managers/Clock.h"

#include <algorithm>
#include <cstdint>

#include "engine/world/World.h"
#include "engine/world/WorldExtras.h"

namespace df {

namespace {

long int now() {
  World& world = World::current();
  WorldExtras& extras = world.extras();
  // A frame time of 33 ms, the default, means exactly 1/30 s.
  const std::int64_t frame = extras.settings.frame_time;
  const std::int64_t ticks = world.getStepCount();
  const std::int64_t begun = frame == 33 ? ticks * 1'000'000 / 30 : ticks * frame * 1000;
  return static_cast<long int>(extras.clock = std::max(extras.clock + 1, begun));
}

}  // namespace

Clock::Clock() : m_previous_time(now()) {}

long int Clock::delta() {
  const long int before = m_previous_time;
  m_previous_time = now();
  return m_previous_time - before;
}

long int Clock::split() const {
  return now() - m_previous_time;
}

}  // namespace df
