// The published models: one per object, shared by all clients.
//
// Clients extrapolate a model exactly as the publisher does, so the publisher knows what is on their screens.
// After each tick it compares that with the world. It changes a model only if the model would draw a wrong
// cell, or if the look or the body has changed. So objects in straight flight cost nothing.
//
// A model determines which cells an object draws, not its exact position. MotionFit finds numbers that take
// few bits and draw the right cells for as long as the path is expected to last.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "engine/world/WorldView.h"
#include "host/snapshot/ChangeIndex.h"
#include "host/snapshot/ModelIndex.h"
#include "host/snapshot/PublishedModel.h"
#include "shared/replica/MotionCodec.h"
#include "shared/replica/Records.h"

namespace naiad {

/// Objects whose published positions must be exact, because views or predictions depend on them.
class ExactObjects {
 public:
  /// Updates the objects that players follow or steer. Returns true if any player has declared controls.
  bool updatePlayers(std::span<const df::PlayerFacts> players) {
    m_keys.clear();
    bool controls = false;
    for (const df::PlayerFacts& player : players) {
      if (player.followed.generation != 0) m_keys.push_back(player.followed);
      if (player.steering.object.generation != 0) m_keys.push_back(player.steering.object);
      controls = controls || player.steering.p_table != nullptr;
    }
    std::sort(m_keys.begin(), m_keys.end(), isBefore);
    return controls;
  }
  const std::vector<df::ObjectKey>& keys() const { return m_keys; }
  bool contains(df::ObjectKey key) const {
    auto found = std::lower_bound(m_keys.begin(), m_keys.end(), key, isBefore);
    for (; found != m_keys.end() && found->slot == key.slot; ++found) {
      if (found->generation == key.generation) return true;
    }
    return false;
  }

  /// Sets whether solid objects that stand still are exact, too.
  void setSolids(bool exact) {
    m_solids_are_new = m_solids_are_new || (exact && !m_solids);
    m_solids = exact;
  }
  bool hasSolids() const { return m_solids; }
  /// True once after setSolids(true) takes effect: the solids published before are still coarse.
  bool popNewSolids() { return std::exchange(m_solids_are_new, false); }

 private:
  static bool isBefore(df::ObjectKey a, df::ObjectKey b) { return a.slot < b.slot; }

  std::vector<df::ObjectKey> m_keys;  ///< sorted by slot
  bool m_solids = false;
  bool m_solids_are_new = false;
};

/// Remembers the looks published recently: whether each recurs, and one shared copy of it.
class LookCatalogue {
 public:
  /// Call when the model has a new look: computes look_sum and `recurs`, and shares the look's memory.
  void enterLook(PublishedModel& model, std::uint32_t tick);

 private:
  void share(Sequence& sequence);

  std::unordered_map<std::uint64_t, std::uint32_t> m_last_used;  ///< tick of the last use, by checksum
  std::unordered_map<std::uint64_t, Sequence> m_sequences;       ///< shared copies of looks, by checksum
};

/// Values per slot that all clients share for one tick, computed on first use.
template <class Value>
class TickCache {
 public:
  /// Drops all values.
  void clear() { ++m_round; }
  /// Returns the value at `index`; null if none was put there since the last clear().
  const Value* find(std::size_t index) const {
    return index < m_entries.size() && m_entries[index].round == m_round ? &m_entries[index].value : nullptr;
  }
  /// Stores a value. `size` must exceed all indices until clear(). The result is valid until the next put().
  const Value& put(std::size_t index, std::size_t size, Value value) {
    m_entries.resize(size);
    m_entries[index] = {m_round, std::move(value)};
    return m_entries[index].value;
  }

 private:
  struct CachedValue {
    std::uint32_t round = 0;
    Value value;
  };
  std::vector<CachedValue> m_entries;
  std::uint32_t m_round = 1;
};

/// Detects views that move too fast to predict which objects enter them.
class ViewMoves {
 public:
  /// Records one tick. Returns true if views have appeared, vanished, moved by more than a cell, or resized.
  bool updateViews(const df::WorldView& view) {
    bool jumped = view.players.size() != m_corners.size();
    m_corners.resize(view.players.size());
    for (std::size_t i = 0; i < m_corners.size(); ++i) {
      const df::FixedVector corner = view.players[i].view_corner;
      const df::FixedVector moved{corner.x - m_corners[i].x, corner.y - m_corners[i].y};
      jumped = jumped || std::max(std::abs(moved.x), std::abs(moved.y)) > df::kFixedOne;
      m_corners[i] = corner;
    }
    const bool resized = std::exchange(m_width, view.view_width) != view.view_width ||
                         std::exchange(m_height, view.view_height) != view.view_height;
    return jumped || resized;
  }

 private:
  std::vector<df::FixedVector> m_corners;  ///< corners in the previous tick
  std::int32_t m_width = 0;
  std::int32_t m_height = 0;
};

class Publisher {
 public:
  using Model = PublishedModel;
  using Forecast = DrawForecast;
  /// A slot that an update changed. If `groups` is 0, the object is gone.
  struct Change {
    std::uint32_t slot = 0;
    std::uint8_t groups = 0;
    CompactRect sweep;  ///< sweepOf() for kSweep ticks, computed once for all clients
  };
  static constexpr std::uint32_t kSweep = 16;

  /// Processes one tick of the world. Afterwards changes() lists the slots whose models clients must learn.
  void update(const df::WorldView& view);

  std::uint32_t tick() const { return m_tick; }
  const std::vector<Change>& changes() const { return m_changes; }
  /// The changes, indexed for searches.
  const ChangeIndex& changeIndex() const { return m_change_index; }
  /// The model in `slot`; null if the slot is empty.
  const Model* find(std::uint32_t slot) const;
  /// Calls `visit(slot, model)` for every live model, in slot order.
  template <class Visit>
  void forEach(Visit visit) const {
    for (std::uint32_t slot = 0; slot < m_models.size(); ++slot) {
      if (m_models[slot].model.alive) visit(slot, m_models[slot].model);
    }
    if (m_free_draw.model.alive) visit(kFreeDrawSlot, m_free_draw.model);
  }
  /// Returns where the model in `slot` may be drawn: now, in `soon` ticks, and up to `later` ticks. Cached
  /// for the last pair of numbers. The reference is valid until the next update() or forecast().
  const Forecast& forecast(std::uint32_t slot, std::uint32_t soon, std::uint32_t later) const {
    const Forecast* cached =
        soon == m_soon && later == m_later ? m_forecasts.find(cacheIndex(slot)) : nullptr;
    return cached != nullptr ? *cached : computeForecast(slot, soon, later);
  }
  /// Returns the encoded motion, at tick(), of the live model in `slot`. It is valid until the next call.
  const SharedMotion& sharedMotion(std::uint32_t slot) const {
    const SharedMotion* cached = m_motions.find(cacheIndex(slot));
    return cached != nullptr ? *cached : shareMotionOf(slot);
  }
  const WorldRecord& world() const { return m_world; }
  /// Calls ModelIndex::forEachNear().
  template <class Visit>
  void forEachNear(const CellRect& rect, std::uint32_t ticks, const CellRect& inner, Visit visit) const {
    m_index.forEachNear(rect, ticks, inner, visit);
  }

  /// Returns an upper bound of the slots: all except kFreeDrawSlot are below it.
  std::size_t slotCount() const { return m_models.size(); }
  /// Number of live models.
  std::size_t liveCount() const { return m_live; }
  /// Highest creation order published so far.
  std::uint64_t newestOrder() const { return m_newest_order; }

  /// Sets whether solid objects that stand still have exact positions, because clients predict moves among
  /// them. Set automatically for the first player with controls.
  void setExactSolids(bool exact) { m_exact.setSolids(exact); }

  /// Number of corrections of models that would have drawn a wrong cell, since the start.
  std::uint64_t correctionCount() const { return m_corrections; }
  /// Number of reports of objects that were ignored because their slot is not below kFreeDrawSlot.
  std::uint64_t refusedCount() const { return m_refused; }

 private:
  struct Tracked {
    Model model;
    Motion truth;           ///< position and velocity as last reported
    Motion path;            ///< motion at the start of the present straight path
    std::uint32_t run = 0;  ///< duration of the previous path, in ticks
    ModelIndex::Membership membership;
    bool shown = true;
    std::uint32_t drawn = 0;      ///< newest tick in which the object's draw() ran
    std::uint32_t off_views = 0;  ///< the look cannot enter a view before this tick
    std::uint8_t changed = 0;
    bool touched = false;  ///< true if the slot is already in m_changes
  };

  /// Returns the index of a slot in the caches; kFreeDrawSlot has the last one.
  std::size_t cacheIndex(std::uint32_t slot) const { return std::min<std::size_t>(slot, m_models.size()); }
  const SharedMotion& shareMotionOf(std::uint32_t slot) const;
  const Forecast& computeForecast(std::uint32_t slot, std::uint32_t soon, std::uint32_t later) const;
  Tracked* track(std::uint32_t slot);
  Motion truthNow(const Tracked& tracked) const;
  void markChanged(std::uint32_t slot, Tracked& tracked, std::uint8_t groups);
  void removeObject(df::ObjectKey key);
  void applyFacts(const df::ObjectFacts& facts);
  void applyDrawing(const df::WorldView& view, const df::DrawnObject& drawn, const Look* declared);
  std::span<const df::DrawCommand> relativeToView(std::span<const df::DrawCommand> drawn,
                                                  df::FixedVector corner);
  void applyFreeDraw(const df::WorldView& view);
  void correctLook(std::uint32_t slot, Tracked& tracked, std::span<const df::DrawCommand> drawn,
                   const Look* declared);
  void captureLook(std::uint32_t slot, Tracked& tracked, std::span<const df::DrawCommand> drawn);
  void correctUndrawnObjects(const df::WorldView& view);
  void correctUndrawnObject(std::uint32_t slot, Tracked& tracked, const df::WorldView& view);
  void applyPath(Tracked& tracked, const Motion& truth);
  void keepSolidsExact();
  void keepExact(df::ObjectKey key);
  void fitModel(Tracked& tracked);
  void indexModel(std::uint32_t slot, Tracked& tracked);
  bool isExact(const Tracked& tracked) const;
  void finishChange(Change& change);

  std::vector<Tracked> m_models;
  std::vector<std::uint32_t> m_examine_at;  ///< tick of the next correctUndrawnObjects() of each slot
  ViewMoves m_views;
  Tracked m_free_draw;
  std::vector<df::DrawCommand> m_off_view;  ///< scratch
  std::vector<Change> m_changes;
  ChangeIndex m_change_index;
  LookCatalogue m_looks;
  ModelIndex m_index;
  ExactObjects m_exact;
  std::uint64_t m_newest_order = 0;
  std::size_t m_live = 0;
  mutable TickCache<Forecast> m_forecasts;
  mutable TickCache<SharedMotion> m_motions;
  mutable std::uint32_t m_soon = 0;  ///< this and m_later are the arguments of all values in m_forecasts
  mutable std::uint32_t m_later = 0;
  WorldRecord m_world;
  std::uint32_t m_tick = 0;
  std::uint64_t m_corrections = 0;
  std::uint64_t m_refused = 0;
};

}  // namespace naiad
