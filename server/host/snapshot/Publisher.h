// The published models: what every client is told about every object, one model for all of them.
//
// Clients extrapolate a model exactly as the publisher does, so the publisher knows what is on their
// screens. After each tick it compares that with the world and changes a model only where it would draw
// something in a wrong cell, or where a look or a body changed. Objects in straight flight cost nothing.
//
// A model says what an object draws, not where it is to the last bit: MotionFit finds numbers that take few
// bits and draw the same cells for as long as the path may be expected to last.
#pragma once

#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "engine/world/WorldView.h"
#include "host/snapshot/ChangeIndex.h"
#include "host/snapshot/InterestGrid.h"
#include "shared/replica/Limits.h"
#include "shared/replica/MotionCodec.h"
#include "shared/replica/Records.h"

namespace naiad {

/// The slot under which characters drawn outside any object's draw() are published.
inline constexpr std::uint32_t kLooseSlot = kMaxSlots - 1;

class Publisher {
 public:
  /// One slot of the published world.
  struct Model {
    std::uint32_t generation = 0;
    bool alive = false;
    ObjectState state;
    std::uint64_t look_sum = 0;  ///< of the sequence; 0 if it is one character or none
    bool recurs = false;         ///< it has been seen before, or changes by itself: worth a name
    std::int32_t reach = 0;      ///< cells from its own that its characters may be drawn in, at most
  };
  /// What an update changed about a slot; groups 0: the object is gone.
  struct Change {
    std::uint32_t slot = 0;
    std::uint8_t groups = 0;
    CompactRect sweep;  ///< sweepOf() for kSweep ticks, so that not every client has to find out
  };
  static constexpr std::uint32_t kSweep = 16;
  /// Where something of a model may be drawn: worked out once in a tick, however many clients ask.
  struct Outlook {
    std::uint32_t generation = 0;  ///< 0: nothing lives there
    CompactRect soon;              ///< now, or at the end of some ticks
    CompactRect later;             ///< at any time in these and some more
  };

  /// Take in one tick of the world. `changes()` then lists what clients have to be told.
  void update(const df::WorldView& view);

  std::uint32_t tick() const { return m_tick; }
  const std::vector<Change>& changes() const { return m_changes; }
  /// The same, arranged to be searched.
  const ChangeIndex& changeIndex() const { return m_change_index; }
  /// The model in `slot`; null if nothing lives there.
  const Model* find(std::uint32_t slot) const;
  /// Call `visit(slot, model)` for every live model, in slot order.
  template <class Visit>
  void forEach(Visit visit) const {
    for (std::uint32_t slot = 0; slot < m_models.size(); ++slot) {
      if (m_models[slot].model.alive) visit(slot, m_models[slot].model);
    }
    if (m_loose.model.alive) visit(kLooseSlot, m_loose.model);
  }
  /// `soon`, `later`: ticks from now. The answer is remembered for the numbers asked for last; valid until
  /// the next update or question.
  const Outlook& outlook(std::uint32_t slot, std::uint32_t soon, std::uint32_t later) const {
    const std::size_t index = slot < m_models.size() ? slot : m_models.size();
    const bool known = soon == m_soon && later == m_later && index < m_outlooks.size() &&
                       m_outlooks[index].update == m_update;
    return known ? m_outlooks[index].outlook : workOut(slot, soon, later);
  }
  /// The motion of the model in `slot`, where one lives, at tick() and in bits. They are the same for all
  /// clients, so they are worked out once. Valid until the next call.
  const SharedMotion& sharedMotion(std::uint32_t slot) const {
    const std::size_t index = std::min<std::size_t>(slot, m_models.size());
    const bool known = index < m_shared.size() && m_shared[index].update == m_update;
    return known ? m_shared[index].motion : share(slot);
  }
  const WorldRecord& world() const { return m_world; }
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
  /// The cells in which something of the model may be drawn from `tick` to `ticks` later, and some more.
  static CellRect sweepOf(const Model& model, std::uint32_t tick, std::uint32_t ticks);

  /// All slots but the loose one are below this.
  std::size_t slotCount() const { return m_models.size(); }
  /// The highest creation order published so far.
  std::uint64_t newestOrder() const { return m_newest_order; }

  /// Positions of solid objects that stand still are to be exact, since clients predict moves among them. On
  /// from the first player with controls on.
  void setExactSolids(bool exact) {
    m_solids_are_coarse = m_solids_are_coarse || (exact && !m_exact_solids);
    m_exact_solids = exact;
  }

  /// Models that reach more cells than this are in everybody's interest.
  static constexpr std::int32_t kWide = 24;

  /// Models corrected because they would have drawn a wrong cell, since the start.
  std::uint64_t correctionCount() const { return m_corrections; }
  /// Objects left out because their slot is beyond kMaxSlots.
  std::uint64_t refusedCount() const { return m_refused; }

 private:
  struct Tracked {
    Model model;
    Motion truth;           ///< where the object was last reported, and how it went on from there
    Motion path;            ///< where its present straight path began
    std::uint32_t run = 0;  ///< ticks that the path before lasted
    bool wide = false;      ///< in m_wide
    bool fast = false;      ///< in m_fast
    bool shown = true;
    std::uint32_t drawn = 0;      ///< newest tick in which its draw() ran
    std::uint32_t off_views = 0;  ///< until this tick nothing of its look can come into a view
    std::uint8_t changed = 0;
    bool touched = false;  ///< in m_changes already
  };

  /// Cells that something gets away, rounded up.
  static std::int64_t cellsIn(std::uint32_t ticks, df::Fixed speed) {
    return (std::int64_t{ticks} * speed >> df::kFixedBits) + 1;
  }
  const SharedMotion& share(std::uint32_t slot) const;
  const Outlook& workOut(std::uint32_t slot, std::uint32_t soon, std::uint32_t later) const;
  Tracked* track(std::uint32_t slot);
  Motion truthNow(const Tracked& tracked) const;
  void mark(std::uint32_t slot, Tracked& tracked, std::uint8_t groups);
  void bury(df::ObjectKey key);
  void takeFacts(const df::ObjectFacts& facts);
  void takeDrawing(const df::WorldView& view, const df::DrawnObject& drawn, const Look* told);
  std::span<const df::DrawCommand> takeOffView(std::span<const df::DrawCommand> drawn,
                                               df::FixedVector corner);
  void takeLoose(const df::WorldView& view);
  void correctLook(std::uint32_t slot, Tracked& tracked, std::span<const df::DrawCommand> drawn,
                   const Look* told);
  void capture(std::uint32_t slot, Tracked& tracked, std::span<const df::DrawCommand> drawn);
  bool haveViewsJumped(const df::WorldView& view);
  void correctUndrawn(const df::WorldView& view);
  void correctUndrawn(std::uint32_t slot, Tracked& tracked, const df::WorldView& view);
  void takePath(Tracked& tracked, const Motion& truth);
  void keepSolidsExact();
  void keepExact(df::ObjectKey key);
  void fit(Tracked& tracked);
  void file(std::uint32_t slot, Tracked& tracked);
  void meet(Model& model);
  void intern(Sequence& sequence);
  bool isExact(const Tracked& tracked) const;
  void finish(Change& change);
  static void list(std::vector<std::uint32_t>& slots, std::uint32_t slot, bool& is_in, bool should_be);

  std::vector<Tracked> m_models;
  std::vector<std::uint32_t> m_look_at;    ///< by slot: the tick in which correctUndrawn() must look at it
  std::vector<df::FixedVector> m_corners;  ///< of the views, a tick ago
  std::int32_t m_view_width = 0;
  std::int32_t m_view_height = 0;
  Tracked m_loose;
  std::vector<df::DrawCommand> m_off_view;  ///< scratch
  std::vector<Change> m_changes;
  ChangeIndex m_change_index;
  std::unordered_map<std::uint64_t, std::uint32_t>
      m_appearances;                                        ///< by sum: the tick they were last taken on
  std::unordered_map<std::uint64_t, Sequence> m_sequences;  ///< by sum: some of those that are published
  InterestGrid m_grid;
  std::vector<std::uint32_t> m_wide;   ///< models that reach farther than kWide, and the loose one
  std::vector<std::uint32_t> m_fast;   ///< models that move by more than a cell per tick, or are accelerated
  std::int32_t m_reach = 0;            ///< of the others, the farthest so far
  df::FixedVector m_speed;             ///< of those not in m_fast, the highest so far, each way
  std::vector<df::ObjectKey> m_exact;  ///< followed by a player: their views and predictions need them exact
  bool m_exact_solids = false;
  bool m_solids_are_coarse = false;  ///< exactness was asked for since the last update
  std::uint64_t m_newest_order = 0;
  /// A cache, by slot; the last one is the loose one's.
  struct Remembered {
    std::uint32_t update = 0;
    Outlook outlook;
  };
  mutable std::vector<Remembered> m_outlooks;
  /// Another one, by slot likewise.
  struct Shared {
    std::uint32_t update = 0;
    SharedMotion motion;
  };
  mutable std::vector<Shared> m_shared;
  mutable std::uint32_t m_update = 1;  ///< counts updates, and changes of the next two
  mutable std::uint32_t m_soon = 0;
  mutable std::uint32_t m_later = 0;
  WorldRecord m_world;
  std::uint32_t m_tick = 0;
  std::uint64_t m_corrections = 0;
  std::uint64_t m_refused = 0;
};

}  // namespace naiad
