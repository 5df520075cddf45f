// Which soft bodies sleep: a body that lies still is not stepped until something near it changes.
#pragma once

#include <span>
#include <vector>

#include "physics/body/SoftTable.h"
#include "physics/geometry/UnionFind.h"

namespace naiad::physics {

/// Neighbours fall asleep together, and wake together.
class SoftSleep {
 public:
  /// A tick begins, with ids below `id_limit`.
  void begin(int id_limit);
  /// How far around its centre of mass the body may touch something in this tick.
  void setReach(int id, Vec2 reach) { m_reaches[static_cast<std::size_t>(id)] = reach; }
  /// Before the step: wakes the sleeping bodies beside one that is awake.
  void wakeNeighbours(SoftTable& table);
  /// After the step: marks the bodies that something movable presses on. They do not sleep.
  static void findLoads(SoftTable& table, std::span<const SoftObstacle> obstacles);
  /// At the end of the tick: puts the bodies to sleep that may, exactly still.
  void update(SoftTable& table);

 private:
  bool areNear(SoftTable& table, int a, int b) const;

  template <class Allows>
  void findGroups(SoftTable& table, Allows allows);

  std::vector<Vec2> m_reaches;  // by id
  UnionFind m_groups;           // of ids
  std::vector<char> m_allows;   // by root
};

}  // namespace naiad::physics
