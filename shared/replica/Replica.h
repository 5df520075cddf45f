// The client's copy of the world: records go in, a picture of any tick comes out.
//
// Not thread-safe. Bounded: a hostile server can make it hold at most kMaxReplicaObjects objects with
// kMaxReplicaGlyphs glyphs.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <unordered_map>
#include <vector>

#include "shared/replica/Acks.h"
#include "shared/replica/Placement.h"
#include "shared/replica/SnapshotCodec.h"
#include "shared/replica/SnapshotDictionary.h"
#include "shared/replica/ViewFollow.h"
#include "shared/values/Canvas.h"

namespace naiad {

/// Objects, dead ones included, that a replica remembers; records for more are ignored and counted.
inline constexpr std::size_t kMaxReplicaObjects = 1u << 17;
/// Glyphs in all looks together (16 bytes each), those of a sequence that several share once, each appearance
/// beyond its first as three more; a look beyond that is ignored and counted.
inline constexpr std::size_t kMaxReplicaGlyphs = 1u << 21;

/// One picture has at most so many objects and so many glyphs, those on top: a view of 400 x 150 cells has
/// 60,000.
inline constexpr std::size_t kMaxDrawnObjects = 1u << 16;
inline constexpr std::size_t kMaxDrawnGlyphs = 1u << 19;

class Replica {
 public:
  /// One remembered object. The newest number applied is kept per group; a death counts for all of them,
  /// so that a late birth cannot bring back the dead.
  struct Entry {
    std::uint8_t generation = 0;
    bool alive = false;
    std::array<std::uint32_t, kGroupCount> newest{};
    ObjectState state;
  };

  /// `tick`: one near those of the snapshots to come (the welcome names it).
  explicit Replica(std::uint32_t tick = 0) : m_context{0, tick, 0} {}
  /// Empty, for a session that goes on with a new world: numbers, ticks and inputs continue from `near`.
  static Replica continuing(const SnapshotContext& near) {
    Replica replica;
    replica.m_context = near;
    return replica;
  }

  /// Read a snapshot of this replica's epoch, without applying it.
  ReadResult read(std::string_view bytes, Snapshot& out) const {
    return readSnapshot(bytes, m_context, m_dictionary, out);
  }
  /// Apply what was read. Order of arrival does not matter, nor does a second time.
  void apply(const Snapshot& snapshot);

  /// Snapshots to come are of ticks near this one, if it is newer than all that were applied.
  void noteTick(std::uint32_t tick) {
    if (isNewer(tick, m_context.tick)) m_context.tick = tick;
  }

  /// Draw the player's view as it is at `tick`: objects by altitude, then creation order, then texts.
  /// The canvas has the size of the view. With a placement, things are drawn where it says. Of more than
  /// kMaxDrawnObjects objects that reach into the view, or kMaxDrawnGlyphs glyphs, the lowest are left out.
  df::Canvas render(std::uint32_t tick, const Placement* p_placement = nullptr) const;

  /// Where the view's upper left corner is at `tick`, in whole world cells.
  CellPosition viewCorner(std::uint32_t tick, const Placement* p_placement = nullptr) const;
  /// Where the followed object is drawn at `tick`, in view cells; the view's centre if there is none.
  CellPosition focus(std::uint32_t tick, const Placement* p_placement = nullptr) const;
  /// Where the object that the player steers is drawn at `tick`, in view cells; nothing if there is none, or
  /// it is outside the view.
  std::optional<CellPosition> ownCell(std::uint32_t tick, const Placement* p_placement = nullptr) const;
  /// The view at `tick` by its record, and the world it looks into.
  ViewFrame viewFrame(std::uint32_t tick) const;
  /// The object that the view follows; null if there is none.
  const ObjectState* followed() const;

  /// The player's own controls, and the newest number that carried them; 0: none has yet.
  const df::ControlTable& controlTable() const { return m_table; }
  std::uint32_t controlTableNumber() const { return m_table_newest; }
  /// What the player steers, by the client's ids, and the newest number that carried it; 0: none has yet.
  const ControlRecord& control() const { return m_control; }
  std::uint32_t controlNumber() const { return m_control_newest; }

  int viewWidth() const { return m_world.view_width; }
  int viewHeight() const { return m_world.view_height; }
  /// Behind all characters of the view.
  df::Color background() const { return m_world.background; }
  std::size_t aliveCount() const { return m_alive; }
  /// The newest snapshot, tick and input that were applied, or the tick of noteTick().
  const SnapshotContext& newest() const { return m_context; }
  /// The live object with this id; null if there is none.
  const Entry* find(std::uint32_t id) const;
  /// By id; those that are not alive are remembered only to ignore what comes late.
  const std::unordered_map<std::uint32_t, Entry>& entries() const { return m_entries; }
  /// A sum over everything the replica holds, the same whatever the order in which it came. PROTOCOL.md
  /// ("Checksum") says of what.
  std::uint64_t checksum() const;
  /// Records left out because the replica was full.
  std::uint64_t overflowCount() const { return m_overflows; }

 private:
  void applyObject(std::uint32_t number, const ObjectRecord& record);
  void end(Entry& entry, std::uint32_t number);
  void setLook(Entry& entry, const Look& look);
  void release(const Sequence& sequence);

  SnapshotContext m_context;
  SnapshotDictionary m_dictionary;
  std::unordered_map<std::uint32_t, Entry> m_entries;
  std::map<std::uint32_t, TextRecord> m_texts;
  std::map<std::uint32_t, std::uint32_t> m_text_newest;
  WorldRecord m_world;
  ViewRecord m_view;
  df::ControlTable m_table;
  ControlRecord m_control;
  std::uint32_t m_table_newest = 0;
  std::uint32_t m_control_newest = 0;
  std::uint32_t m_world_newest = 0;
  std::uint32_t m_view_newest = 0;
  std::uint32_t m_view_tick = 0;  ///< the tick at which m_view holds
  std::size_t m_alive = 0;
  std::unordered_map<const void*, std::uint32_t> m_uses;  ///< looks by identity() of their sequence
  std::size_t m_glyphs = 0;                               ///< in these sequences
  std::uint64_t m_overflows = 0;
};

}  // namespace naiad
