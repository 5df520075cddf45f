// Which Objects the soft bodies of a world touch: from the solver's ids to what games hear.
#pragma once

#include <vector>

#include "engine/world/WorldStore.h"
#include "physics/body/BodyPlan.h"
#include "physics/body/SoftMeetings.h"
#include "physics/body/SoftTable.h"

namespace df {

class SoftTouches {
 public:
  /// After the soft bodies' step: appends the contacts that began in it, or ended. An end is between those
  /// who began, even if what was touched is out of sight by now; of who is gone there is none.
  void collect(const WorldStore& store, naiad::physics::SoftTable& table, const SoftMeetings& meetings,
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
