// Contacts of the soft bodies of a world: from the solver's ids to the Objects of events.
#pragma once

#include <vector>

#include "engine/world/WorldStore.h"
#include "physics/body/BodyState.h"
#include "physics/body/SoftObstacles.h"
#include "physics/body/SoftTable.h"

namespace df {

class SoftContacts {
 public:
  /// After the soft bodies' step: appends the contacts that began in it, or ended. An end is between the
  /// same Objects as the begin, even if the obstacle is not near any more; for a deleted Object there is
  /// none.
  void collect(const WorldStore& store, naiad::physics::SoftTable& table, const SoftObstacles& obstacles,
               std::vector<naiad::physics::BodyContact>& news);

 private:
  struct Touch {
    ObjectKey first, second;
    // What the solver calls them.
    int body;
    int other;
    bool is_other_soft;
  };

  std::vector<Touch> m_touching;
};

}  // namespace df
