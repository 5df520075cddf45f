// Finds published models by position: those near a rectangle, and those too wide or fast for the grid.
#pragma once

#include <cstdint>
#include <vector>

#include "host/snapshot/InterestGrid.h"
#include "host/snapshot/PublishedModel.h"

namespace naiad {

class ModelIndex {
 public:
  /// Records which lists contain a model; stored with the model.
  struct Membership {
    bool wide = false;
    bool fast = false;
  };

  /// Call when the model was born or died, or its reach changed. `position`: position of its object.
  void indexModel(std::uint32_t slot, const PublishedModel& model, df::FixedVector position,
                  Membership& membership);
  /// Call when the object has moved.
  void indexMove(std::uint32_t slot, df::FixedVector position, const Membership& membership) {
    if (!membership.wide) m_grid.put(slot, {df::cellOf(position.x), df::cellOf(position.y)});
  }
  /// Call when the model died or has another motion.
  void indexMotion(std::uint32_t slot, const PublishedModel& model, Membership& membership);
  /// Updates the maximum speed of the models that are not fast. Call for each changed model.
  void updateMaxSpeed(const PublishedModel& model, const Membership& membership);

  /// Calls `visit(slot)` for every live model that may be drawn in `rect` within this many ticks, and for
  /// some other models. May skip models well inside `inner`. Visits wide models and models that may move by
  /// more than a cell per tick wherever they are. May visit a model twice.
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
  /// Returns an upper bound of the cells covered in `ticks` at this speed: rounded down, plus 1.
  static std::int64_t cellsIn(std::uint32_t ticks, df::Fixed speed) {
    return (std::int64_t{ticks} * speed >> df::kFixedBits) + 1;
  }

  InterestGrid m_grid;                ///< models that are not wide
  std::vector<std::uint32_t> m_wide;  ///< models with a reach above kWide, and kFreeDrawSlot
  std::vector<std::uint32_t> m_fast;  ///< models that move by more than a cell per tick, or are accelerated
  std::int32_t m_reach = 0;           ///< highest reach so far, in cells, of models that are not wide
  df::FixedVector m_speed;            ///< highest speed so far on each axis of the models that are not fast
};

}  // namespace naiad
