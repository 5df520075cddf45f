// The published models by place: those near a rectangle of cells, and those too wide or fast to have one
// place.
#pragma once

#include <cstdint>
#include <vector>

#include "host/snapshot/InterestGrid.h"
#include "host/snapshot/PublishedModel.h"

namespace naiad {

class ModelIndex {
 public:
  /// The lists that a model is in; kept beside the model.
  struct Membership {
    bool wide = false;
    bool fast = false;
  };

  /// The model was born or died, or its reach changed. `position`: of its object.
  void fileModel(std::uint32_t slot, const PublishedModel& model, df::FixedVector position,
                 Membership& membership);
  /// The object has moved.
  void fileMove(std::uint32_t slot, df::FixedVector position, const Membership& membership) {
    if (!membership.wide) m_grid.put(slot, {df::cellOf(position.x), df::cellOf(position.y)});
  }
  /// The model died or has another motion.
  void fileMotion(std::uint32_t slot, const PublishedModel& model, Membership& membership);
  /// The index knows the speed of all models that are not fast; to be called for each that changed.
  void noteSpeed(const PublishedModel& model, const Membership& membership);

  /// Call `visit(slot)` for every live model of which something may be drawn in `rect` within so many ticks,
  /// and for some around it, but those well inside `inner` may be left out. Models that are wide or faster
  /// than a cell per tick are visited wherever they are; some models twice.
  template <class Visit>
  void forEachNear(const CellRect& rect, std::uint32_t ticks, const CellRect& inner, Visit visit) const {
    const std::int64_t x = m_reach + cellsIn(ticks, m_speed.x);
    const std::int64_t y = m_reach + cellsIn(ticks, m_speed.y);
    m_grid.forEachNear({rect.left - x, rect.top - y, rect.right + x, rect.bottom + y}, inner, visit);
    for (const std::vector<std::uint32_t>* slots : {&m_wide, &m_fast}) {
      for (const std::uint32_t slot : *slots) visit(slot);
    }
  }

 private:
  /// Cells covered at this speed, rounded up.
  static std::int64_t cellsIn(std::uint32_t ticks, df::Fixed speed) {
    return (std::int64_t{ticks} * speed >> df::kFixedBits) + 1;
  }

  InterestGrid m_grid;                ///< of those that are not wide
  std::vector<std::uint32_t> m_wide;  ///< models that reach farther than kWide, and the loose one
  std::vector<std::uint32_t> m_fast;  ///< models that move by more than a cell per tick, or are accelerated
  std::int32_t m_reach = 0;           ///< of those that are not wide, the farthest so far
  df::FixedVector m_speed;            ///< of those that are not fast, the highest so far on each axis
};

}  // namespace naiad
