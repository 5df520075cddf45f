#include "client/world/Prediction.h"

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "client/world/ReplicaBarriers.h"
#include "shared/replica/Acks.h"
#include "shared/replica/ViewFollow.h"

namespace naiad {

void Prediction::applyControl(const ControlRecord& record) {
  if (m_known && !isNewer(record.tick, m_known->tick)) return;
  const bool same = m_known && m_known->slot == record.slot && m_known->generation == record.generation;
  if (const Guess& made = guess(record.tick); same && made.made && made.tick == record.tick) {
    ++(made.position == record.position ? m_counters.confirmed : m_counters.mispredicted);
  }
  if (!same) m_guesses = {};
  m_known = record;
  while (!m_inputs.empty() && record.newest_input != 0 &&
         !isNewer(m_inputs.front().id, record.newest_input)) {
    m_inputs.pop_front();
  }
}

void Prediction::addInput(Input input) {
  if (m_inputs.size() >= kMaxInputs) {
    ++m_counters.unpredicted;
    return;
  }
  // The server applies inputs in the order they were sent.
  if (!m_inputs.empty() && isNewer(m_inputs.back().tick, input.tick)) input.tick = m_inputs.back().tick;
  m_inputs.push_back(input);
}

void Prediction::reset() {
  const Counters counters = m_counters;
  *this = {};
  m_counters = counters;
}

void Prediction::run(const Replica& replica, std::uint32_t tick) {
  m_active = false;
  if (!m_known || m_known->generation == 0 || m_table.rows.empty()) return;
  const Replica::ReplicaObject* p_own = replica.find(m_known->slot);
  if (p_own == nullptr || p_own->generation != m_known->generation) return;
  m_active = true;
  m_order = p_own->state.order;
  replay(replica, p_own->state, tick);
}

void Prediction::replay(const Replica& replica, const ObjectState& own, std::uint32_t tick) {
  ControlRecord start = *m_known;
  // The server publishes changes within kMaxAhead, so silence means that nothing has changed.
  if (isNewer(tick, start.tick + kMaxAhead)) start.tick = tick - kMaxAhead;
  m_from = start.tick;
  const std::uint32_t ticks = isNewer(tick, start.tick) ? tick - start.tick : 0;

  const df::FixedBox from = boxAt(own.body, start.position).value_or(df::FixedBox{});
  const ReplicaBarriers surroundings(replica, own, from, reach(ticks), start.tick, start.tick + ticks);
  PredictedObject copy(start, m_table, &surroundings);
  auto input = m_inputs.begin();
  for (std::uint32_t i = 0; i < ticks; ++i) {
    copy.beginTick();
    const std::uint32_t now = copy.now().tick;
    for (; input != m_inputs.end() && !isNewer(input->tick, now); ++input)
      copy.applyKey(static_cast<df::Keyboard::Key>(input->key),
                    static_cast<df::EventKeyboardAction>(input->action));
    copy.finishTick();
    guess(now) = {true, now, copy.position()};
  }
  m_position = copy.position();
  m_velocity = copy.velocity();
  m_trail = copy.trail();
}

/// Returns an upper bound of the distance that the object can move in `ticks`.
df::FixedVector Prediction::reach(std::uint32_t ticks) const {
  df::FixedVector fastest{std::abs(m_known->velocity.x), std::abs(m_known->velocity.y)};
  df::FixedVector longest;
  for (const df::ControlRow& row : m_table.rows) {
    df::FixedVector& most = row.effect == df::ControlEffect::kStep ? longest : fastest;
    most.x = std::max(most.x, std::abs(row.value.x));
    most.y = std::max(most.y, std::abs(row.value.y));
  }
  const auto far = [this, ticks](df::Fixed fast, df::Fixed gain, df::Fixed step) {
    const auto n = static_cast<df::Fixed>(ticks);
    const auto steps = static_cast<df::Fixed>(m_inputs.size() * df::kMaxControlRows);
    constexpr df::Fixed kFar = df::fromCells(40'000'000);  // so that no sum of these overflows
    return std::min(
        n * std::min(fast, kFar / 128) + n * n * std::min(std::abs(gain), kFar / 32768) + steps * step, kFar);
  };
  return {far(fastest.x, m_known->acceleration.x, longest.x),
          far(fastest.y, m_known->acceleration.y, longest.y)};
}

df::FixedVector Prediction::viewCorner(const Replica& replica) const {
  ViewFrame frame = replica.viewFrame(m_from);
  for (const df::FixedVector place : m_trail) frame.corner = followView(frame, place);
  return frame.corner;
}

}  // namespace naiad
