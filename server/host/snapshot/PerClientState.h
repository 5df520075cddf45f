// What one client receives beside objects: the world, its view, its controls, its newest input, its texts,
// and the origins that positions are counted from.
//
// Each part is pending as a whole when it changes, is sent when a snapshot carries it, and is pending again
// when that snapshot is lost, in its newest state.
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
/// A view that leaves the window gets another one, in another slot. Snapshots name the new slot only once the
/// client has confirmed it.
class OriginChoice {
 public:
  /// The view has moved. Returns the slot whose window has to be sent; 0: none.
  std::uint32_t updateWindow(CellPosition view_corner, const WorldRecord& world, std::uint64_t newest_order);
  /// The client has received the slot as it is now.
  void confirmArrival(std::uint32_t slot);

  /// The slot that snapshots name; 0: none yet.
  std::uint32_t slot() const { return m_slot; }
  const Origin& window() const { return m_origins[m_slot]; }
  const Origin& at(std::uint32_t slot) const { return m_origins[slot]; }

 private:
  std::array<Origin, kOriginSlots + 1> m_origins;
  std::uint32_t m_slot = 0;
  std::uint32_t m_newest = 0;  ///< the slot set last
};

/// The state of the steered object as a client computes it from the last record that it was sent.
/// Computes coast() a tick at a time.
class AckedControl {
 public:
  /// `record` was sent.
  void setSent(const ControlRecord& record);
  /// Does `actual` follow from the last record by the same table? Ticks must not go back.
  bool implies(const ControlRecord& actual, const df::ControlTable& table);

 private:
  bool m_has_record = false;
  bool m_at_rest = false;  ///< coasting changes nothing any more
  int m_coasted = 0;       ///< ticks
  ControlRecord m_model;
};

class PerClientState {
 public:
  /// Take in one published tick and what this player sees of it.
  void applyTick(const Publisher& publisher, const df::PlayerFacts& player);
  /// The newest input that the game has had, and its tick.
  void noteInput(std::uint32_t id, std::uint32_t tick);
  /// Mark as pending what this client cannot compute: its view, the state of the object that it steers. Once
  /// a tick, before write(), and after `known` has taken in the tick.
  void queueCorrections(const Publisher& publisher, const KnownObjects& known);

  /// Name the newest input in the header, until the client is known to have received it.
  void writeInput(SnapshotHeader& header) const;
  /// Write what is pending and fits into snapshot `number`, which has `limit` bytes. With `repeats`, what is
  /// small and urgent is sent once more by queueRepeats(). Returns whether anything was sent.
  bool write(SnapshotWriter& writer, std::uint32_t number, std::size_t limit, bool repeats);
  /// Mark as pending what write() chose to repeat, unless it is known to have arrived. Once a tick.
  void queueRepeats();

  /// The snapshot arrived; `probe`: it carried nothing.
  void confirmArrival(std::uint32_t number, bool probe);
  /// The snapshot was lost. Returns whether anything is pending again because of it.
  bool requeueLost(std::uint32_t number);

  bool hasPending() const { return m_pending != 0; }
  /// An upper bound of the bits that are pending, without a table of controls, which waits for room.
  std::size_t maxPendingBits() const { return static_cast<std::size_t>(std::popcount(m_pending)) * kMaxBits; }

  /// As of the last tick, without name, colour, score and window.
  const df::PlayerFacts& player() const { return m_player; }
  const WorldRecord& world() const { return m_world; }
  const OriginChoice& origins() const { return m_origins; }
  std::uint32_t input() const { return m_input; }
  std::uint32_t inputTick() const { return m_input_tick; }

 private:
  struct State {
    std::uint32_t sent = 0;  ///< number of the newest snapshot that carried it
    bool arrived = false;    ///< of the newest sending
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

  /// Of any part but the table: a text of kMaxViewWidth characters is the longest.
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
  ControlRecord controlNow(std::uint32_t tick, const KnownObjects& known) const;
  void queueControl(std::uint32_t tick, const KnownObjects& known);

  std::array<State, kCount> m_states;
  std::uint32_t m_pending = 0;    ///< a bit for each part
  std::uint32_t m_to_repeat = 0;  ///< to be repeated in the next tick
  std::uint32_t m_repeated = 0;   ///< that this tick repeats
  WorldRecord m_world;
  ViewRecord m_view;              ///< as last sent
  std::uint32_t m_view_tick = 0;  ///< the tick at which m_view holds
  OriginChoice m_origins;
  std::uint32_t m_input = 0;
  std::uint32_t m_input_tick = 0;
  df::PlayerFacts m_player;
  std::array<df::PlayerText, kMaxTexts> m_texts;
  std::string m_table;      ///< the player's controls as last sent, encoded; empty: none
  ControlRecord m_control;  ///< to be sent, if pending
  AckedControl m_acked_control;
};

}  // namespace naiad
