// SOFT bodies and SOFT Objects are sensors: they get contact events but push nothing.
#pragma once

#include <vector>

#include "engine/world/World.h"
#include "engine/world/WorldStore.h"
#include "physics/body/BodyContacts.h"
#include "physics/body/BodyState.h"
#include "physics/body/BodySurroundings.h"
#include "physics/broadphase/ImpactTree.h"
#include "physics/impact/ImpactBody.h"

namespace naiad::physics {

/// Keeps the contacts of sensors from tick to tick. Shapes that an ImpactWorld cannot have count as boxes.
class BodySensors {
 public:
  /// Call after all bodies have moved. Adds the contacts of sensors that began on the bodies' paths, or
  /// ended. Pairs without a SOFT member are handled by the solvers.
  void step(const WorldStore& store, const BodyTable& table, const std::vector<BodyState>& states,
            BodyContacts& contacts);

  /// Returns the number of pairs examined since the world was made.
  std::int64_t pairs() const { return m_examined; }

 private:
  struct Mover {
    ObjectKey key;
    std::uint64_t order = 0;
    bool is_body = false;
    bool is_soft = false;
    ImpactBody shape;   ///< the centre is that at the beginning of the tick
    Vec2 displacement;  ///< movement since the beginning of the tick
  };
  struct Touch {
    ObjectKey first, second;  ///< `first` is a body, `second` a later body or an Object
    friend bool operator==(const Touch& a, const Touch& b) {
      return a.first == b.first && a.second == b.second;
    }
  };
  struct Pair {
    Touch touch;
    std::uint32_t a = 0, b = 0;  ///< indices of movers
  };

  static bool isBefore(const Touch& a, const Touch& b);
  static bool isPairBefore(const Pair& a, const Pair& b) { return isBefore(a.touch, b.touch); }
  static Mover moverOf(const WorldStore& store, const BodyTable& table, const BodyState& state);
  static Mover moverOf(const WorldStore& store, const Metric& metric, ObjectKey key);
  void findBodyPairs();
  void findObjectPairs(const WorldStore& store, const Metric& metric);
  void findPartedPairs(const WorldStore& store, const Metric& metric, BodyContacts& contacts);
  void add(std::size_t a, std::size_t b);
  void sortPairs();
  void examine(const Pair& pair, bool were_touching, BodyContacts& contacts);

  std::vector<Mover> m_movers;    // bodies in creation order, then the Objects of m_pairs
  std::size_t m_bodies = 0;       // number of movers that are bodies
  std::vector<Pair> m_pairs;      // pairs to examine, sorted by slots
  std::vector<Pair> m_sorted;     // scratch memory of sortPairs()
  std::vector<Touch> m_touching;  // pairs that touched at the end of the last tick, sorted by slots
  std::vector<Touch> m_now;
  std::vector<std::uint32_t> m_by_slot;  // the bodies among the movers, by slot
  std::vector<std::size_t> m_asking;     // indices of movers, by the number of their region
  ImpactTree m_soft;                     // the SOFT bodies
  std::vector<SweptBox> m_boxes;
  std::vector<int> m_ids;
  BodySurroundings m_surroundings;
  std::int64_t m_examined = 0;
};

}  // namespace naiad::physics
