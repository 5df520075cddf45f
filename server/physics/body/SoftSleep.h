// Which soft bodies sleep: a body that lies still is not stepped until something near it changes.
#pragma once

#include <span>
#include <vector>

#include "physics/body/SoftTable.h"

namespace naiad::physics {

/// Neighbours fall asleep together, and wake together.
class SoftSleep {
 public:
  /// A tick begins, with ids below `id_limit`.
  void begin(int id_limit);
  /// How far around its centre of mass the body may touch something in this tick.
  void setReach(int id, Vec2 reach) { m_reaches[static_cast<std::size_t>(id)] = reach; }
  /// Before the step: wakes the sleeping bodies beside one that is awake.
  void wakeNeighbours(SoftTable& table) const;
  /// After the step: marks the bodies that something movable presses on. They do not sleep.
  static void findLoads(SoftTable& table, std::span<const SoftObstacle> obstacles);
  /// At the end of the tick: puts the bodies to sleep that may, exactly still.
  void update(SoftTable& table);

 private:
  bool areNear(SoftTable& table, int a, int b) const;

  std::vector<Vec2> m_reaches;  // by id
  std::vector<char> m_sleeps;   // likewise: may it sleep after this tick?
};

}  // namespace naiad::physics
