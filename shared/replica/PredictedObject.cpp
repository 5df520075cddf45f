#include "shared/replica/PredictedObject.h"

#include "shared/values/FixedRange.h"

namespace naiad {

PredictedObject::PredictedObject(const ControlRecord& known, const df::ControlTable& table,
                                 const Barriers* p_barriers)
    : m_table(table), m_p_barriers(p_barriers), m_now(known) {}

void PredictedObject::beginTick() {
  ++m_now.tick;
  beginControlTick(m_table, m_now.state, *this);
}

void PredictedObject::applyKey(df::Keyboard::Key key, df::EventKeyboardAction action) {
  applyControlKey(m_table, m_now.state, key, action, *this);
}

void PredictedObject::finishTick() {
  if (m_now.velocity != df::FixedVector{}) move(m_now.position + m_now.velocity, true);
  const df::FixedVector next = m_now.velocity + m_now.acceleration;
  if (isWithin(next, df::kMaxVelocity)) m_now.velocity = next;
}

void PredictedObject::move(df::FixedVector to, bool in_update) {
  if (!isWithin(to, df::kMaxPosition)) return;
  if (m_p_barriers != nullptr && m_p_barriers->isBlocked(to, m_now.tick, in_update)) return;
  m_now.position = to;
  m_trail.push_back(to);
}

ControlRecord deadReckon(const ControlRecord& known, const df::ControlTable& table, std::uint32_t tick) {
  PredictedObject copy(known, table);
  for (int i = 0; i < kMaxDeadReckoning && copy.now().tick != tick; ++i) {
    copy.beginTick();
    copy.finishTick();
  }
  ControlRecord then = copy.now();
  then.tick = tick;
  return then;
}

}  // namespace naiad
