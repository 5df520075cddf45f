// The client's copy of the world: it takes records and draws the picture of any tick.
//
// Not thread-safe. Bounded: a hostile server can make it store at most kMaxReplicaObjects objects with
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

/// Maximum number of objects, dead ones included, that a replica remembers; further records are only counted.
inline constexpr std::size_t kMaxReplicaObjects = 1u << 17;
/// Maximum glyphs of all looks together (16 bytes each). A shared sequence counts once, and each appearance
/// after its first counts as three more glyphs. A look beyond the limit is ignored and counted.
inline constexpr std::size_t kMaxReplicaGlyphs = 1u << 21;

/// Maximum objects and glyphs of one picture; the topmost are kept. A view of 400 x 150 has 60,000 cells.
inline constexpr std::size_t kMaxDrawnObjects = 1u << 16;
inline constexpr std::size_t kMaxDrawnGlyphs = 1u << 19;

class Replica {
 public:
  /// One remembered object. Stores the newest applied number of each group; a death sets all of them, so that
  /// a late birth cannot revive the object.
  struct ReplicaObject {
    std::uint8_t generation = 0;
    bool alive = false;
    std::array<std::uint32_t, kGroupCount> newest{};
    ObjectState state;
  };

  /// `tick`: a tick near those of the first snapshots (the welcome contains one).
  explicit Replica(std::uint32_t tick = 0) : m_context{0, tick, 0} {}
  /// Returns an empty replica for a session in a new world: numbers, ticks and inputs continue from `near`.
  static Replica continuing(const SnapshotContext& near) {
    Replica replica;
    replica.m_context = near;
    return replica;
  }

  /// Reads a snapshot of this replica's epoch, without applying it.
  ReadResult read(std::string_view bytes, Snapshot& out) const {
    return readSnapshot(bytes, m_context, m_dictionary, out);
  }
  /// Applies a snapshot. The order does not matter, and repeating it has no effect.
  void apply(const Snapshot& snapshot);

  /// Expects later snapshots near this tick, if it is newer than all applied ones.
  void advanceTick(std::uint32_t tick) {
    if (isNewer(tick, m_context.tick)) m_context.tick = tick;
  }

  /// Draws the player's view at `tick`: objects by altitude, then creation order, then texts. The canvas has
  /// the size of the view. A placement overrides positions. Beyond kMaxDrawnObjects objects that reach into
  /// the view, or kMaxDrawnGlyphs glyphs, the lowest objects are omitted.
  df::Canvas render(std::uint32_t tick, const Placement* p_placement = nullptr) const;

  /// Returns the view's upper left corner at `tick`, in whole world cells.
  CellPosition viewCorner(std::uint32_t tick, const Placement* p_placement = nullptr) const;
  /// Returns the view cell of the followed object at `tick`; the view's centre if no object is followed.
  CellPosition focus(std::uint32_t tick, const Placement* p_placement = nullptr) const;
  /// Returns the view cell of the player's steered object at `tick`; nullopt without one in the view.
  std::optional<CellPosition> ownCell(std::uint32_t tick, const Placement* p_placement = nullptr) const;
  /// Returns the view at `tick` according to its record, and the boundary of its world.
  ViewFrame viewFrame(std::uint32_t tick) const;
  /// Returns the object that the view follows, or null.
  const ObjectState* followed() const;

  /// The player's control table, and the number of the newest snapshot that contained one; 0: none yet.
  const df::ControlTable& controlTable() const { return m_table; }
  std::uint32_t controlTableNumber() const { return m_table_newest; }
  /// The steered object's state, with the client's ids, and the number of the newest snapshot that contained
  /// one; 0: none yet.
  const ControlRecord& control() const { return m_control; }
  std::uint32_t controlNumber() const { return m_control_newest; }

  int viewWidth() const { return m_world.view_width; }
  int viewHeight() const { return m_world.view_height; }
  /// The colour behind all characters of the view.
  df::Color background() const { return m_world.background; }
  std::size_t aliveCount() const { return m_alive; }
  /// Returns the newest applied snapshot number, tick and input; the tick may be that of advanceTick().
  const SnapshotContext& newest() const { return m_context; }
  /// Returns the live object with this id, or null.
  const ReplicaObject* find(std::uint32_t id) const;
  /// All objects by id. Dead ones are kept only to ignore late records.
  const std::unordered_map<std::uint32_t, ReplicaObject>& entries() const { return m_entries; }
  /// Returns a checksum of all objects, independent of the order of arrival (PROTOCOL.md, "Checksum").
  std::uint64_t checksum() const;
  /// The number of records ignored because the replica was full.
  std::uint64_t overflowCount() const { return m_overflows; }

 private:
  void applyObject(std::uint32_t number, const ObjectRecord& record);
  void end(ReplicaObject& entry, std::uint32_t number);
  void setLook(ReplicaObject& entry, const Look& look);
  void release(const Sequence& sequence);

  SnapshotContext m_context;
  SnapshotDictionary m_dictionary;
  std::unordered_map<std::uint32_t, ReplicaObject> m_entries;
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
  std::unordered_map<const void*, std::uint32_t> m_uses;  ///< number of looks by identity() of their sequence
  std::size_t m_glyphs = 0;                               ///< weight of these sequences
  std::uint64_t m_overflows = 0;
};

}  // namespace naiad
