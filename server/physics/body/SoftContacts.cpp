#include "physics/body/SoftContacts.h"

#include <algorithm>

namespace df {

using naiad::physics::BodyContact;
using naiad::physics::SoftEvent;

void SoftContacts::collect(const WorldStore& store, naiad::physics::SoftTable& table,
                           const SoftObstacles& obstacles, std::vector<BodyContact>& news) {
  std::erase_if(m_touching, [&](const Touch& touch) {
    return !store.isCurrent(touch.first) || !store.isCurrent(touch.second);
  });
  for (const SoftEvent& event : table.world().events()) {
    const auto touch = std::find_if(m_touching.begin(), m_touching.end(), [&](const Touch& t) {
      return t.body == event.body && t.other == event.other && t.is_other_soft == event.is_other_soft;
    });
    const bool is_known = touch != m_touching.end();
    if (!event.is_begin && !is_known) continue;
    Touch current;
    if (event.is_begin) {
      current = {table.entry(event.body).key,
                 event.is_other_soft ? table.entry(event.other).key : obstacles.keyOf(event.other),
                 event.body, event.other, event.is_other_soft};
      if (!store.isCurrent(current.first) || !store.isCurrent(current.second)) continue;
      m_touching.push_back(current);
    } else {
      current = *touch;
      m_touching.erase(touch);
    }
    news.push_back({1, current.first, current.second, store.order(current.first.slot),
                    store.order(current.second.slot), event.impulse, event.is_begin,
                    naiad::physics::BodySolver::kFlight});
  }
}

}  // namespace df
