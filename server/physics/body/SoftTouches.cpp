#include "physics/body/SoftTouches.h"

#include <algorithm>

namespace df {

using naiad::physics::BodyContact;
using naiad::physics::SoftEvent;

void SoftTouches::collect(const WorldStore& store, naiad::physics::SoftTable& table,
                          const SoftMeetings& meetings, std::vector<BodyContact>& news) {
  std::erase_if(m_touching, [&](const Touch& touch) {
    return !store.isCurrent(touch.first) || !store.isCurrent(touch.second);
  });
  for (const SoftEvent& event : table.world().events()) {
    const auto touch = std::find_if(m_touching.begin(), m_touching.end(), [&](const Touch& t) {
      return t.body == event.body && t.other == event.other && t.is_other_soft == event.is_other_soft;
    });
    const bool is_known = touch != m_touching.end();
    if (!event.is_begin && !is_known) continue;
    Touch told;
    if (event.is_begin) {
      told = {table.seat(event.body).key,
              event.is_other_soft ? table.seat(event.other).key : meetings.keyOf(event.other), event.body,
              event.other, event.is_other_soft};
      if (!store.isCurrent(told.first) || !store.isCurrent(told.second)) continue;
      m_touching.push_back(told);
    } else {
      told = *touch;
      m_touching.erase(touch);
    }
    news.push_back({1, told.first, told.second, store.order(told.first.slot), store.order(told.second.slot),
                    event.impulse, event.is_begin, naiad::physics::BodyWay::kAlone});
  }
}

}  // namespace df
