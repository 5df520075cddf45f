// What one client is told beside objects: the world, its view, its controls, its newest input, its texts, and
// from where positions are counted.
//
// Each of these is owed as a whole when it changes, paid when a snapshot carries it, and owed again when that
// snapshot is lost, in its newest state.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <string>
#include <vector>

#include "host/snapshot/AckedControl.h"
#include "host/snapshot/KnownObjects.h"
#include "host/snapshot/OriginChoice.h"
#include "host/snapshot/Publisher.h"
#include "shared/replica/SnapshotCodec.h"

namespace naiad {

class PerClientState {
 public:
  /// Note one published tick and what this player sees of it.
  void note(const Publisher& publisher, const df::PlayerFacts& player);
  /// The newest input that the game has had, and in which tick.
  void noteInput(std::uint32_t id, std::uint32_t tick);
  /// Owe what this client could not work out for itself: its view, the state of what it steers. Once a tick,
  /// before write(), and after `known` was told of the tick.
  void check(const Publisher& publisher, const KnownObjects& known);

  /// Let the header name the newest input until the client is known to have heard of it.
  void tellInput(SnapshotHeader& header) const;
  /// Write what is owed and fits in a snapshot of `limit` bytes; what did is paid by snapshot `number`. With
  /// `repeats`, what is small and matters at once is to be sent once more by repeatAhead(). Whether anything
  /// was paid.
  bool write(SnapshotWriter& writer, std::uint32_t number, std::size_t limit, bool repeats);
  /// Owe again what write() said was to be repeated, unless it is known to have arrived. Once a tick.
  void repeatAhead();

  /// The snapshot arrived; `probe`: it carried nothing.
  void arrived(std::uint32_t number, bool probe);
  /// The snapshot was lost. Whether something is owed again because of it.
  bool lost(std::uint32_t number);

  bool isOwing() const { return m_owed != 0; }
  /// More than what is owed takes, unless it is a table of controls, which waits for room.
  std::size_t mostBits() const { return static_cast<std::size_t>(std::popcount(m_owed)) * kMaxBits; }

  /// As last noted. Of name, colour, score and window nothing is kept.
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

  /// None takes more: a text of kMaxViewWidth characters.
  static constexpr std::size_t kMaxBits = 15 * kMaxViewWidth + 64;

  bool isOwed(std::size_t single) const { return (m_owed >> single & 1) != 0; }
  void owe(std::size_t single) { m_owed |= 1u << single; }
  void pay(std::size_t single, std::uint32_t number, bool repeats);
  void write(std::size_t single, SnapshotWriter& writer);
  void notePlayer(const df::PlayerFacts& player);
  void noteTexts(const std::vector<df::PlayerText>& now);
  void noteTable();
  void noteOrigin(const Publisher& publisher);
  const Motion* followedMotion(const Publisher& publisher, const KnownObjects& known) const;
  void checkView(const Publisher& publisher, const KnownObjects& known);
  ControlRecord controlNow(std::uint32_t tick, const KnownObjects& known) const;
  void checkControl(std::uint32_t tick, const KnownObjects& known);

  std::array<State, kCount> m_states;
  std::uint32_t m_owed = 0;      ///< a bit each
  std::uint32_t m_ahead = 0;     ///< to be repeated in the next tick
  std::uint32_t m_repeated = 0;  ///< that this tick repeats
  WorldRecord m_world;
  ViewRecord m_view;              ///< as last sent
  std::uint32_t m_view_tick = 0;  ///< the tick at which m_view holds
  OriginChoice m_origins;
  std::uint32_t m_input = 0;
  std::uint32_t m_input_tick = 0;
  df::PlayerFacts m_player;
  std::array<df::PlayerText, kMaxTexts> m_texts;
  std::string m_table;      ///< the player's controls as last told, encoded; empty: none
  ControlRecord m_control;  ///< to be told, if owed
  AckedControl m_acked_control;
};

}  // namespace naiad
