// SOFT bodies and SOFT Objects are sensors: they get contact events, and push nothing.
#pragma once

#include <vector>

#include "engine/world/World.h"
#include "engine/world/WorldStore.h"
#include "physics/body/BodyState.h"
#include "physics/body/BodySurroundings.h"
#include "physics/impact/ImpactBody.h"

namespace df {

/// The contacts of sensors, kept from tick to tick. Shapes that an ImpactWorld does not know count as the
/// Object's box.
class BodySensors {
 public:
  /// After all bodies have moved: appends the contacts that began on their paths, or ended. (A pair of which
  /// neither is SOFT belongs to the solvers.)
  void step(const WorldStore& store, const naiad::physics::BodyTable& table,
            const std::vector<naiad::physics::BodyState>& states,
            std::vector<naiad::physics::BodyContact>& contacts);

 private:
  struct Mover {
    ObjectKey key;
    std::uint64_t order = 0;
    bool is_body = false;
    bool is_soft = false;
    naiad::physics::ImpactBody shape;   ///< where its middle was when the tick began
    naiad::physics::Vec2 displacement;  ///< since then
  };
  struct Touch {
    Mover first, second;
  };

  static Mover moverOf(const WorldStore& store, const naiad::physics::BodyTable& table,
                       const naiad::physics::BodyState& state);
  static Mover moverOf(const WorldStore& store, const naiad::physics::Metric& metric, ObjectKey key);
  void findObjectPairs(const WorldStore& store, const naiad::physics::Metric& metric);
  void add(const Mover& a, const Mover& b);
  bool wereTouching(const Touch& touch) const;

  std::vector<Mover> m_movers;    // bodies, by plan
  std::vector<Touch> m_pairs;     // to be examined
  std::vector<Touch> m_touching;  // at the end of the last tick, by order
  std::vector<Touch> m_now;
  std::vector<std::size_t> m_asking;  // movers, by number of their region
  BodySurroundings m_surroundings;
};

}  // namespace df
