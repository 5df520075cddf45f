#include "LookBack.h"

#include <algorithm>

#include "Acks.h"

namespace naiad {

void LookBack::note(const Publisher& publisher) {
  const bool goes_on = m_began && publisher.tick() == m_tick + 1;
  m_tick = publisher.tick();
  m_began = true;
  if (!goes_on) {
    m_histories.clear();
    publisher.forEach(
        [this](std::uint32_t slot, const Publisher::Model& model) { learn(slot, model, true); });
    return;
  }
  for (const Publisher::Change& change : publisher.changes()) {
    const Publisher::Model* p_model = publisher.find(change.slot);
    if (p_model == nullptr) {
      forget(change.slot);
    } else {
      learn(change.slot, *p_model, (change.groups & (kLife | kMotion)) != 0);
    }
  }
}

void LookBack::learn(std::uint32_t slot, const Publisher::Model& model, bool moved) {
  if (slot == kLooseSlot) return;  // no object
  if (slot >= m_histories.size()) m_histories.resize(std::size_t{slot} + 1);
  History& history = m_histories[slot];
  if (history.generation != model.generation) history = {model.generation, m_tick, {}};
  if (!moved && !history.motions.empty()) return;
  history.motions.push_back({m_tick, model.state.motion});
  // What another one followed within the time kept, nobody need remember.
  while (history.motions.size() > 1 && !isNewer(history.motions[1].since, m_tick - kTicks)) {
    history.motions.pop_front();
  }
}

void LookBack::forget(std::uint32_t slot) {
  if (slot < m_histories.size()) m_histories[slot] = {};
}

std::optional<df::FixedVector> LookBack::positionOf(df::ObjectKey object, const df::Seen& seen) const {
  if (!seen.known || object.generation == 0 || object.slot >= m_histories.size()) return std::nullopt;
  const History& history = m_histories[object.slot];
  if (history.generation != object.generation) return std::nullopt;
  const std::uint32_t oldest = m_tick - kTicks;
  const std::uint32_t base = isNewer(seen.base, oldest) ? seen.base : oldest;
  if (isNewer(history.born, base)) return std::nullopt;

  const auto known = std::find_if(history.motions.rbegin(), history.motions.rend(),
                                  [base](const Known& k) { return !isNewer(k.since, base); });
  const Known& then = known != history.motions.rend() ? *known : history.motions.front();
  const std::uint32_t drawn = isNewer(seen.drawn, m_tick)                 ? m_tick
                              : isNewer(m_tick - kMostBehind, seen.drawn) ? m_tick - kMostBehind
                                                                          : seen.drawn;
  return positionAt(then.motion, drawn);
}

}  // namespace naiad
