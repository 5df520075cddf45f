// Counts the game's join and leave events.
#pragma once

#include <atomic>

#include "BusyWorld.h"
#include "engine/world/EventPlayer.h"
#include "engine/world/Object.h"

namespace naiad::test {

/// Numbers of join and leave events of all players. May be read from any thread. Must outlive the server.
struct Census {
  std::atomic<int> joins = 0;
  std::atomic<int> leaves = 0;
};

class Clerk : public df::Object {
 public:
  explicit Clerk(Census& census) : m_census(census) {
    setType("Clerk");
    setSolidness(df::SPECTRAL);
    setVisible(false);
    registerInterest(df::JOIN_EVENT);
    registerInterest(df::LEAVE_EVENT);
  }
  int eventHandler(const df::Event* p_e) override {
    if (p_e->getType() == df::JOIN_EVENT) ++m_census.joins;
    if (p_e->getType() == df::LEAVE_EVENT) ++m_census.leaves;
    return 0;
  }

 private:
  Census& m_census;
};

/// Returns a function that makes a busy world with `census` in it, for a TestServer.
inline auto countedWorld(Census& census, int count) {
  return [&census, count](df::World& world) {
    populateBusyWorld(world, count);
    new Clerk(census);
  };
}

}  // namespace naiad::test
