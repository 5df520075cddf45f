// The published models: what every client is told about every object, one model for all of them.
//
// Clients extrapolate a model exactly as the publisher does, so the publisher knows what is on their
// screens. After each tick it compares that with the world and changes a model only where it would draw
// something in a wrong cell, or where a look or a body changed. Objects in straight flight cost nothing.
//
// A model says what an object draws, not where it is to the last bit: MotionFit finds numbers that take few
// bits and draw the same cells for as long as the path may be expected to last.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/world/WorldView.h"
#include "host/snapshot/ChangeIndex.h"
#include "host/snapshot/ExactObjects.h"
#include "host/snapshot/LookCatalogue.h"
#include "host/snapshot/ModelIndex.h"
#include "host/snapshot/PublishedModel.h"
#include "host/snapshot/TickCache.h"
#include "host/snapshot/ViewMoves.h"
#include "shared/replica/MotionCodec.h"
#include "shared/replica/Records.h"

namespace naiad {

class Publisher {
 public:
  using Model = PublishedModel;
  using Outlook = ModelOutlook;
  /// What an update changed about a slot; groups 0: the object is gone.
  struct Change {
    std::uint32_t slot = 0;
    std::uint8_t groups = 0;
    CompactRect sweep;  ///< sweepOf() for kSweep ticks, so that not every client has to find out
  };
  static constexpr std::uint32_t kSweep = 16;

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
  /// Where something of the model in `slot` may be drawn, now, in `soon` ticks and up to `later` ticks. It is
  /// remembered for the numbers of ticks asked for last; valid until the next update or question.
  const Outlook& outlook(std::uint32_t slot, std::uint32_t soon, std::uint32_t later) const {
    const Outlook* known = soon == m_soon && later == m_later ? m_outlooks.find(cacheIndex(slot)) : nullptr;
    return known != nullptr ? *known : workOut(slot, soon, later);
  }
  /// The motion of the model in `slot`, where one lives, at tick() and in bits. Valid until the next call.
  const SharedMotion& sharedMotion(std::uint32_t slot) const {
    const SharedMotion* known = m_motions.find(cacheIndex(slot));
    return known != nullptr ? *known : share(slot);
  }
  const WorldRecord& world() const { return m_world; }
  /// ModelIndex::forEachNear() among the models.
  template <class Visit>
  void forEachNear(const CellRect& rect, std::uint32_t ticks, const CellRect& inner, Visit visit) const {
    m_index.forEachNear(rect, ticks, inner, visit);
  }

  /// All slots but the loose one are below this.
  std::size_t slotCount() const { return m_models.size(); }
  /// The highest creation order published so far.
  std::uint64_t newestOrder() const { return m_newest_order; }

  /// Positions of solid objects that stand still are to be exact, since clients predict moves among them. On
  /// from the first player with controls on.
  void setExactSolids(bool exact) { m_exact.setSolids(exact); }

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
    ModelIndex::Membership membership;
    bool shown = true;
    std::uint32_t drawn = 0;      ///< newest tick in which its draw() ran
    std::uint32_t off_views = 0;  ///< until this tick nothing of its look can come into a view
    std::uint8_t changed = 0;
    bool touched = false;  ///< in m_changes already
  };

  /// In the caches; the loose one's is the last.
  std::size_t cacheIndex(std::uint32_t slot) const { return std::min<std::size_t>(slot, m_models.size()); }
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
  void correctUndrawn(const df::WorldView& view);
  void correctUndrawn(std::uint32_t slot, Tracked& tracked, const df::WorldView& view);
  void takePath(Tracked& tracked, const Motion& truth);
  void keepSolidsExact();
  void keepExact(df::ObjectKey key);
  void fit(Tracked& tracked);
  void file(std::uint32_t slot, Tracked& tracked);
  bool isExact(const Tracked& tracked) const;
  void finish(Change& change);

  std::vector<Tracked> m_models;
  std::vector<std::uint32_t> m_look_at;  ///< by slot: the tick in which correctUndrawn() must look at it
  ViewMoves m_views;
  Tracked m_loose;
  std::vector<df::DrawCommand> m_off_view;  ///< scratch
  std::vector<Change> m_changes;
  ChangeIndex m_change_index;
  LookCatalogue m_looks;
  ModelIndex m_index;
  ExactObjects m_exact;
  std::uint64_t m_newest_order = 0;
  mutable TickCache<Outlook> m_outlooks;
  mutable TickCache<SharedMotion> m_motions;
  mutable std::uint32_t m_soon = 0;  ///< of m_outlooks
  mutable std::uint32_t m_later = 0;
  WorldRecord m_world;
  std::uint32_t m_tick = 0;
  std::uint64_t m_corrections = 0;
  std::uint64_t m_refused = 0;
};

}  // namespace naiad
