// The obstacles of a solver: HARD Objects without mass that bodies may run into in this tick.
//
// They are found by the world's own grid, and kept while a body is near. An Object without bodies near it
// costs nothing.
#pragma once

#include <vector>

#include "engine/world/WorldStore.h"
#include "physics/body/Metric.h"
#include "physics/body/WorldNames.h"

namespace naiad::physics {

class BodyObstacles {
 public:
  struct Obstacle {
    ObjectKey key;
    int id = -1;  ///< the solver's; −1: it does not know it yet
    bool is_near = true;
  };

  /// No obstacle is near, until it is marked.
  void beginTick();
  void markNear(ObjectKey key);
  /// Ordered by slot. The solver takes in those without an id, and drops those that are not near.
  std::vector<Obstacle>& all() { return m_all; }
  void removeFar() {
    std::erase_if(m_all, [](const Obstacle& obstacle) { return !obstacle.is_near; });
  }

  /// Is the Object one: solid, HARD, and no body?
  static bool isObstacle(const WorldStore& store, ObjectKey key) {
    return store.isCurrent(key) && store.collides(key.slot) && store.solidness(key.slot) == HARD &&
           !store.has(key.slot, WorldStore::kBody);
  }

 private:
  std::vector<Obstacle> m_all;
};

/// Everything within `half` to either side of `centre`, in the world's own numbers, and a little more.
FixedBox regionOf(const Metric& metric, const Place& centre, Vec2 half);

}  // namespace naiad::physics
