// Decides which soft bodies sleep: a body that lies still is not stepped until something near it changes.
#pragma once

#include <span>
#include <vector>

#include "physics/body/SoftTable.h"
#include "physics/geometry/UnionFind.h"

namespace naiad::physics {

/// Neighbouring soft bodies fall asleep and wake together.
class SoftSleep {
 public:
  /// Begins a tick; all ids are less than `id_limit`.
  void begin(int id_limit);
  /// Sets how far around its centre of mass the body may touch something in this tick.
  void setReach(int id, Vec2 reach) { m_reaches[static_cast<std::size_t>(id)] = reach; }
  /// Call before the step: wakes sleeping bodies next to one that is awake.
  void wakeNeighbours(SoftTable& table);
  /// Call after the step: marks bodies on which something movable presses. They do not sleep.
  static void findLoads(SoftTable& table, std::span<const SoftObstacle> obstacles);
  /// Call at the end of the tick: puts bodies to sleep, with velocity zero, if they may.
  void update(SoftTable& table);

 private:
  bool areNear(SoftTable& table, int a, int b) const;

  template <class Allows>
  void findGroups(SoftTable& table, Allows allows);

  std::vector<Vec2> m_reaches;  // by id of the soft body
  UnionFind m_groups;           // groups of bodies near each other, by id
  std::vector<char> m_allows;   // by root of m_groups: 1 if the group may sleep
};

}  // namespace naiad::physics
