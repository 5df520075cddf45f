// The collision rules of docs/collisions.md for a mover and one other Object.
#pragma once

#include <optional>
#include <vector>

#include "engine/collision/Sweep.h"
#include "engine/world/WorldStore.h"

namespace df {

/// A moving Object and one that it may touch, both in the world, with their present state in the store.
class CollisionRule {
 public:
  CollisionRule(const WorldStore& store, WorldStore::Slot mover, WorldStore::Slot other)
      : m_store(store), m_mover(mover), m_other(other) {}

  /// True if the pair blocks: both are HARD, or the mover is no-soft and the other SOFT.
  bool blocks() const {
    const Solidness own = m_store.solidness(m_mover);
    const Solidness its = m_store.solidness(m_other);
    return (own == HARD && its == HARD) || (its == SOFT && m_store.has(m_mover, WorldStore::kNoSoft));
  }
  /// Like blocks(), but false if this path lets the mover move out of the other (Object::setMayMoveOut).
  bool blocks(FixedVector from, FixedVector to) const { return blocks() && !movesOut(from, to); }
  /// Returns when the pair first collides on this path: by boxes or, if either is precise, by characters.
  std::optional<Moment> firstCollision(const Sweep& sweep) const { return firstCollision(sweep, otherBox()); }
  /// Like firstCollision(sweep), given the other's box in world coordinates.
  std::optional<Moment> firstCollision(const Sweep& sweep, const FixedBox& box) const {
    if (!m_store.hasPrecise() || !isPrecise()) return sweep.firstTouch(box);
    return sweep.firstShare(m_store.mask(m_mover), box, m_store.mask(m_other));
  }
  /// True if the pair collides with the mover's box at `box`, which touches the other's box: a precise pair
  /// must share a cell.
  bool collidesIn(const FixedBox& box) const {
    return !isPrecise() || shareCell(m_store.mask(m_mover), box, m_store.mask(m_other), otherBox());
  }

 private:
  bool isPrecise() const {
    return ((m_store.flags(m_mover) | m_store.flags(m_other)) & WorldStore::kPrecise) != 0;
  }
  bool movesOut(FixedVector from, FixedVector to) const {
    return m_store.mayMoveOut(m_mover) && Sweep(m_store.box(m_mover), from, to).movesOutOf(otherBox());
  }
  FixedBox otherBox() const { return m_store.worldBox(m_other, m_store.position(m_other)); }

  const WorldStore& m_store;
  WorldStore::Slot m_mover;
  WorldStore::Slot m_other;
};

/// Removes from `others`, whose boxes touch `box`, the Objects that the mover does not collide with there.
inline void filterCollisions(const WorldStore& store, WorldStore::Slot mover, const FixedBox& box,
                             std::vector<ObjectKey>& others) {
  if (!store.hasPrecise()) return;
  std::erase_if(others,
                [&](ObjectKey other) { return !CollisionRule(store, mover, other.slot).collidesIn(box); });
}

}  // namespace df
