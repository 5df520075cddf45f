// A drawing rule for ticks that have not arrived yet: HARD objects are not drawn inside one another.
//
// Extrapolated objects fly into walls; on the server they are blocked. So a HARD object is drawn where it was
// one tick before it would first touch another HARD one that it did not touch in the newest known tick. The
// replica does not change.
//
// A clamp is made for one picture: the objects are sorted into cells once, then each moving one is tested
// against its neighbours only. In a pile all objects are neighbours, so the work for one picture is limited.
// Each moving object has a share of it; when that is used up, only contacts found so far block the object.
// Objects beyond the limit of the index are drawn where extrapolation puts them, and block nothing.
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
  /// Limit on tested ticks; nothing is clamped in a longer extrapolation.
  static constexpr std::uint32_t kMaxTicks = 16;
  /// Limit on the work for one picture, in boxes computed or compared and cells looked up: about two
  /// milliseconds. 200 HARD objects that move in one spot stay below it.
  static constexpr std::size_t kMaxWork = 200'000;

  /// Makes the clamp for the picture of tick `drawn`; the newest snapshot was of `known`. The replica must
  /// outlive this and must not change.
  ExtrapolationClamp(const Replica& replica, std::uint32_t known, std::uint32_t drawn);

  /// Returns where an object of the replica is drawn.
  df::FixedVector positionOf(const ObjectState& object) const;

  /// Returns the work done: at most kMaxWork, plus one unfinished test or cell per moving object. It depends
  /// only on the constructor's arguments.
  std::size_t work() const { return m_work; }
  /// True if the work limit was reached, so that some contacts may be missing.
  bool isExhausted() const { return m_exhausted; }

 private:
  /// A rectangle of cells of the index, including its edges.
  struct Range {
    std::int64_t left, top, right, bottom;
    std::int64_t count() const { return (right - left + 1) * (bottom - top + 1); }
  };
  struct Solid {
    const ObjectState* p_state;
    df::FixedBox along;  ///< smallest box around all its boxes from known to drawn
    Range range;
    std::size_t first_box;  ///< index of its first box in m_boxes; one per tick from known to drawn
    bool moves;             ///< false: there is only one box
  };
  using Cell = std::uint64_t;

  static Range cellsOf(const df::FixedBox& box);
  bool addSolid(const ObjectState& object);
  void addToIndex(const Solid& solid, std::uint32_t index);
  void clampAll();
  template <class Visit>
  void forEachNear(const Solid& mover, std::size_t allowed, Visit visit);
  std::uint32_t firstTouch(const Solid& mover, const Solid& other, std::uint32_t before);
  const df::FixedBox& boxOf(const Solid& solid, std::uint32_t tick) const {
    return m_boxes[solid.first_box + (solid.moves ? tick : 0)];
  }

  std::uint32_t m_known;
  std::uint32_t m_drawn;
  std::uint32_t m_ticks = 0;  ///< number of ticks from known to drawn; 0: nothing is clamped
  std::size_t m_work = 0;
  bool m_exhausted = false;
  std::vector<df::FixedBox> m_boxes;
  std::vector<Solid> m_solids;
  std::vector<std::pair<Cell, std::uint32_t>> m_cells;  ///< sorted; the number is an index into m_solids
  std::vector<std::uint32_t> m_large;                   ///< indices of solids in too many cells for the index
  std::unordered_map<const ObjectState*, df::FixedVector> m_clamped;  ///< positions of clamped objects
};

/// Makes a clamp and returns where it draws `object`. For several objects, make one clamp instead.
df::FixedVector clampedPosition(const Replica& replica, const ObjectState& object, std::uint32_t known,
                                std::uint32_t drawn);

}  // namespace naiad
