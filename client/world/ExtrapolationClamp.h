// A drawing rule for ticks that have not arrived yet: HARD objects are not drawn inside one another.
//
// Extrapolated objects fly into walls; on the server they are blocked. So a HARD object is drawn where it was
// one tick before it would first touch another HARD one that it did not touch in the newest known tick. The
// models stay as they are.
//
// Made for one picture: the objects are sorted into cells once, then each is tested against its neighbours
// only.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "shared/replica/Replica.h"

namespace naiad {

class ExtrapolationClamp {
 public:
  /// Ticks that are tested, at most; the rest of a longer extrapolation is drawn as modelled.
  static constexpr std::uint32_t kMaxTicks = 16;

  /// For the picture of `drawn`, when the newest snapshot was of `known`. The replica must outlive this and
  /// must not change.
  ExtrapolationClamp(const Replica& replica, std::uint32_t known, std::uint32_t drawn);

  /// Where `object`, one of the replica's, is drawn.
  df::FixedVector positionOf(const ObjectState& object) const;

 private:
  /// Cells of the index, edges included.
  struct Range {
    std::int64_t left, top, right, bottom;
    std::int64_t count() const { return (right - left + 1) * (bottom - top + 1); }
  };
  struct Solid {
    std::uint64_t order;
    df::FixedBox along;  ///< around all its places from known to drawn
    Range range;
    std::size_t places;  ///< where its boxes begin in m_places, one for each tick from known to drawn
  };
  using Cell = std::uint64_t;

  static Range cellsOf(const df::FixedBox& box);
  void sort(const Solid& solid, std::uint32_t index);
  template <class Visit>
  void forEachNear(const df::FixedBox& box, Visit visit) const;
  std::uint32_t firstTouch(const std::vector<df::FixedBox>& mover, std::uint64_t order, const Solid& other,
                           std::uint32_t before) const;

  std::uint32_t m_known;
  std::uint32_t m_drawn;
  std::uint32_t m_ticks = 0;  ///< from known to drawn; 0: nothing is clamped
  std::vector<df::FixedBox> m_places;
  std::vector<Solid> m_solids;
  std::vector<std::pair<Cell, std::uint32_t>> m_cells;  ///< sorted; the number is an index into m_solids
  std::vector<std::uint32_t> m_large;                   ///< indices of those in too many cells
};

/// Where a clamp made for this call draws one object. For several objects, make the clamp once.
df::FixedVector clampedPosition(const Replica& replica, const ObjectState& object, std::uint32_t known,
                                std::uint32_t drawn);

}  // namespace naiad
