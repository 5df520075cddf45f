// A drawing rule for ticks that have not arrived yet: HARD objects are not drawn inside one another.
//
// Extrapolated objects fly into walls; on the server they are blocked. So a HARD object is drawn where it was
// one tick before it would first touch another HARD one that it did not touch in the newest known tick. The
// models stay as they are.
//
// Made for one picture: the objects are sorted into cells once, then each that moves is tested against its
// neighbours only. In a pile all are neighbours of all, so the work for one picture is limited: each moving
// object has a share of it, and one whose share is used up is blocked by what was found until then. Objects
// that the index has no room for are drawn as modelled and block nothing.
#pragma once

#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <utility>
#include <vector>

#include "shared/replica/Replica.h"

namespace naiad {

class ExtrapolationClamp {
 public:
  /// Ticks that are tested, at most; the rest of a longer extrapolation is drawn as modelled.
  static constexpr std::uint32_t kMaxTicks = 16;
  /// Work for one picture, at most: boxes that are computed or compared, and cells that are looked up. About
  /// two milliseconds; 200 HARD objects that move in one spot stay below it.
  static constexpr std::size_t kMaxWork = 200'000;

  /// For the picture of `drawn`, when the newest snapshot was of `known`. The replica must outlive this and
  /// must not change.
  ExtrapolationClamp(const Replica& replica, std::uint32_t known, std::uint32_t drawn);

  /// Where `object`, one of the replica's, is drawn.
  df::FixedVector positionOf(const ObjectState& object) const;

  /// What it took: kMaxWork at most, and for each moving object one test or cell that was begun. Depends on
  /// the replica alone.
  std::size_t work() const { return m_work; }
  /// Was anything left out because of the limit?
  bool isExhausted() const { return m_exhausted; }

 private:
  /// Cells of the index, edges included.
  struct Range {
    std::int64_t left, top, right, bottom;
    std::int64_t count() const { return (right - left + 1) * (bottom - top + 1); }
  };
  struct Solid {
    const ObjectState* p_state;
    df::FixedBox along;  ///< around all its places from known to drawn
    Range range;
    std::size_t places;  ///< where its boxes begin in m_places, one for each tick from known to drawn
    bool moves;          ///< else there is one box
  };
  using Cell = std::uint64_t;

  static Range cellsOf(const df::FixedBox& box);
  bool addSolid(const ObjectState& object);
  void addToIndex(const Solid& solid, std::uint32_t index);
  void clampAll();
  template <class Visit>
  void forEachNear(const Solid& mover, std::size_t allowed, Visit visit);
  std::uint32_t firstTouch(const Solid& mover, const Solid& other, std::uint32_t before);
  const df::FixedBox& placeOf(const Solid& solid, std::uint32_t tick) const {
    return m_places[solid.places + (solid.moves ? tick : 0)];
  }

  std::uint32_t m_known;
  std::uint32_t m_drawn;
  std::uint32_t m_ticks = 0;  ///< from known to drawn; 0: nothing is clamped
  std::size_t m_work = 0;
  bool m_exhausted = false;
  std::vector<df::FixedBox> m_places;
  std::vector<Solid> m_solids;
  std::vector<std::pair<Cell, std::uint32_t>> m_cells;  ///< sorted; the number is an index into m_solids
  std::vector<std::uint32_t> m_large;                   ///< indices of those in too many cells
  std::unordered_map<const ObjectState*, df::FixedVector> m_held;  ///< those that are not where modelled
};

/// Where a clamp made for this call draws one object. For several objects, make the clamp once.
df::FixedVector clampedPosition(const Replica& replica, const ObjectState& object, std::uint32_t known,
                                std::uint32_t drawn);

}  // namespace naiad
