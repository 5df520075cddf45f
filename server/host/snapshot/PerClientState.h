// The state that one client receives in addition to objects: the world, its view, its controls, its newest
// input, its texts, and the origins that positions are relative to.
//
// When a part changes, all of it is pending until a snapshot carries it. If that snapshot is lost, the part
// is pending again, in its newest state.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <string>
#include <vector>

#include "host/snapshot/KnownObjects.h"
#include "host/snapshot/Publisher.h"
#include "shared/replica/ControlCodec.h"
#include "shared/replica/SnapshotCodec.h"

namespace naiad {

/// The origin of one client's positions: a window around its view, so that positions take few bits.
///
/// When the view leaves the window, or the newest creation orders are too far from the window's, a new window
/// is sent in another slot. Snapshots use the new slot only after the client has confirmed it.
class OriginChoice {
 public:
  /// Call when the view may have moved. Returns the slot whose window has to be sent; 0: none.
  std::uint32_t updateWindow(CellPosition view_corner, const WorldRecord& world, std::uint64_t newest_order);
  /// Call when the client has received the present window of the slot.
  void confirmArrival(std::uint32_t slot);

  /// The slot that snapshots use; 0: none yet.
  std::uint32_t slot() const { return m_slot; }
  const Origin& window() const { return m_origins[m_slot]; }
  const Origin& at(std::uint32_t slot) const { return m_origins[slot]; }

 private:
  std::array<Origin, kOriginSlots + 1> m_origins;
  std::uint32_t m_slot = 0;
  std::uint32_t m_newest = 0;  ///< the slot set last
};

/// The steered object's state as a client computes it from its newest record: deadReckon(), tick by tick.
class ControlExtrapolator {
 public:
  /// Call when `record` was sent.
  void setSent(const ControlRecord& record);
  /// True if a client computes `actual` from the newest record and this table. Ticks must not decrease.
  bool implies(const ControlRecord& actual, const df::ControlTable& table);

 private:
  bool m_has_record = false;
  bool m_at_rest = false;  ///< true if coasting changes nothing any more
  int m_coasted = 0;       ///< ticks computed since the record
  ControlRecord m_model;
};

class PerClientState {
 public:
  /// Updates the parts from one published tick and this player's facts.
  void applyTick(const Publisher& publisher, const df::PlayerFacts& player);
  /// Sets the newest input that the game has applied, and its tick.
  void setNewestInput(std::uint32_t id, std::uint32_t tick);
  /// Marks the client's view and the state of the object that it steers as pending if the client cannot
  /// compute them. Call once a tick, before write() and after `known` was updated for the tick.
  void queueCorrections(const Publisher& publisher, const KnownObjects& known);

  /// Puts the newest input into the header, until the client is known to have received it.
  void writeInput(SnapshotHeader& header) const;
  /// Writes the pending parts that fit into snapshot `number` of at most `limit` bytes. With `repeats`, small
  /// urgent parts are sent a second time by queueRepeats(). Returns whether anything was written.
  bool write(SnapshotWriter& writer, std::uint32_t number, std::size_t limit, bool repeats);
  /// Once a tick, marks the parts that write() chose to repeat as pending, unless they have arrived.
  void queueRepeats();

  /// Call when the snapshot arrived. `probe`: true if the snapshot was an empty probe.
  void confirmArrival(std::uint32_t number, bool probe);
  /// Call when the snapshot was lost. Returns whether anything is pending again because of it.
  bool requeueLost(std::uint32_t number);

  bool hasPending() const { return m_pending != 0; }
  /// Maximum bits of the pending parts, without a control table, which waits for a snapshot with space.
  std::size_t maxPendingBits() const { return static_cast<std::size_t>(std::popcount(m_pending)) * kMaxBits; }

  /// The player's facts in the last tick, without name, colour, score and window.
  const df::PlayerFacts& player() const { return m_player; }
  const WorldRecord& world() const { return m_world; }
  const OriginChoice& origins() const { return m_origins; }
  std::uint32_t input() const { return m_input; }
  std::uint32_t inputTick() const { return m_input_tick; }

 private:
  struct State {
    std::uint32_t sent = 0;  ///< number of the newest snapshot that carried the part; 0: none
    bool arrived = false;    ///< true if the part is known to have arrived as sent then
  };
  enum Index : std::size_t {
    kWorld,
    kView,
    kInput,
    kTable,
    kControl,
    kOrigins,
    kTexts = kOrigins + kOriginSlots,
    kCount = kTexts + kMaxTexts
  };
  static_assert(kCount <= 32);

  /// Upper bound of the bits of a part, except the table; the longest is a text of kMaxViewWidth characters.
  static constexpr std::size_t kMaxBits = 15 * kMaxViewWidth + 64;

  bool isPending(std::size_t part) const { return (m_pending >> part & 1) != 0; }
  void markPending(std::size_t part) { m_pending |= 1u << part; }
  void markSent(std::size_t part, std::uint32_t number, bool repeats);
  void write(std::size_t part, SnapshotWriter& writer);
  void applyPlayer(const df::PlayerFacts& player);
  void applyTexts(const std::vector<df::PlayerText>& now);
  void applyTable();
  void applyOrigin(const Publisher& publisher);
  const Motion* followedMotion(const Publisher& publisher, const KnownObjects& known) const;
  void queueView(const Publisher& publisher, const KnownObjects& known);
  ControlRecord currentControl(std::uint32_t tick, const KnownObjects& known) const;
  void queueControl(std::uint32_t tick, const KnownObjects& known);

  std::array<State, kCount> m_states;
  std::uint32_t m_pending = 0;    ///< one bit per part
  std::uint32_t m_to_repeat = 0;  ///< parts to repeat in the next tick
  std::uint32_t m_repeated = 0;   ///< parts repeated in this tick
  WorldRecord m_world;
  ViewRecord m_view;              ///< view as last sent, or to be sent while pending
  std::uint32_t m_view_tick = 0;  ///< tick of m_view
  OriginChoice m_origins;
  std::uint32_t m_input = 0;
  std::uint32_t m_input_tick = 0;
  df::PlayerFacts m_player;
  std::array<df::PlayerText, kMaxTexts> m_texts;
  std::string m_table;      ///< the player's controls, encoded, as last sent or pending; empty: none yet
  ControlRecord m_control;  ///< the newest state, to be sent while pending
  ControlExtrapolator m_control_extrapolator;
};

}  // namespace naiad
