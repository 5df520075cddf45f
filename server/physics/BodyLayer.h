// The physics' part of a world's update(): all bodies fly for one tick, at once.
//
// A world gets this layer with its first Body or its first PM.set…, and pays nothing before.
#pragma once

#include <memory>
#include <vector>

#include "BodyTable.h"
#include "Layer.h"

namespace df {

class BodyLayer : public Layer {
 public:
  BodyLayer() : m_table(std::make_shared<naiad::physics::BodyTable>()) {}
  /// The layer of this world; made if there is none.
  static BodyLayer& of(World& world);

  void step(World& world) override;
  const std::shared_ptr<naiad::physics::BodyTable>& table() { return m_table; }

 private:
  using Row = naiad::physics::BodyRow;
  void fly(World& world, naiad::physics::BodyTable::Index index);
  void tell(World& world, Row& row, naiad::physics::Vec2 acceleration);
  void quarantine(World& world, Row& row, const char* why);

  struct Moved {
    ObjectKey key;
    FixedVector where;
  };
  std::shared_ptr<naiad::physics::BodyTable> m_table;
  std::vector<Moved> m_moved;  ///< in this step; kept for its memory
};

}  // namespace df
