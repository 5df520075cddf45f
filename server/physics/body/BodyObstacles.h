// The obstacles of a solver: HARD Objects without mass that bodies may hit in this tick.
//
// The world's grid finds the obstacles; they are kept while a body is near. All other Objects cost nothing.
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
    int id = -1;  ///< id in the solver; −1: not added yet
    bool is_near = true;
  };

  /// Begins a tick; markNear() marks the obstacles that are near.
  void beginTick();
  void markNear(ObjectKey key);
  /// Returns the obstacles by slot. The solver adds those without an id and removes those that are not near.
  std::vector<Obstacle>& all() { return m_all; }
  void removeFar() {
    std::erase_if(m_all, [](const Obstacle& obstacle) { return !obstacle.is_near; });
  }

  /// True if the Object is an obstacle: solid, HARD and not a body.
  static bool isObstacle(const WorldStore& store, ObjectKey key) {
    return store.isCurrent(key) && store.collides(key.slot) && store.solidness(key.slot) == HARD &&
           !store.has(key.slot, WorldStore::kBody);
  }

 private:
  std::vector<Obstacle> m_all;
};

/// Returns the box that extends by `half` to each side of `centre`, slightly enlarged, in world coordinates.
FixedBox regionOf(const Metric& metric, const Place& centre, Vec2 half);

}  // namespace naiad::physics
