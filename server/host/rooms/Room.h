// A room: a world, the players in it, and the state of the data sent to them.
//
// A host has one room, one for each player (HostOptions::players), or named ones (--room). The host owns the
// sessions. A room lists the sessions that play in it, until remove().
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "host/process/StageClock.h"
#include "host/rooms/SoundBroadcaster.h"
#include "host/rounds/RoomConfig.h"
#include "host/rounds/Round.h"
#include "host/session/Session.h"
#include "host/snapshot/Publisher.h"
#include "shared/replica/TruthFile.h"
#include "shared/replica/UpdateCodec.h"
#include "shared/values/Keyboard.h"

namespace naiad {

/// Selects the player whose input reaches the game, if only one player's does (HostOptions::players "first").
class InputFocus {
 public:
  explicit InputFocus(bool first_only) : m_first_only(first_only) {}

  bool isExclusive() const { return m_first_only; }
  /// Returns the player whose turn it is, or 0.
  std::uint32_t player() const { return m_player; }
  /// Gives the turn to this player (0: none). Returns true if the turn passed from one player to another.
  bool moveTo(std::uint32_t player) {
    if (player == m_player) return false;
    m_before = std::exchange(m_player, player);
    return player != 0 && m_before != 0;
  }
  /// True if this input may reach the game: input is not exclusive, or the player has the turn, or had it
  /// before and releases a key.
  bool accepts(std::uint32_t player, const Input& input) const {
    if (!m_first_only || player == m_player) return true;
    return !input.is_mouse && input.action == df::KEY_RELEASED && player == m_before;
  }

 private:
  bool m_first_only;
  std::uint32_t m_player = 0;
  std::uint32_t m_before = 0;
};

class Room {
 public:
  /// `first_only`: only the first player's input reaches the game. `stages` measures the parts of a tick and
  /// must outlive the room.
  Room(std::unique_ptr<Round> round, bool first_only, StageClock& stages);
  Room(const Room&) = delete;
  Room& operator=(const Room&) = delete;

  /// The current round. A sleeping room has one with a NullWorld.
  Round& round() { return *m_p_round; }
  const Round& round() const { return *m_p_round; }

  // Named rooms.

  /// The room's name and settings; null if it has no name (--room was not given).
  const RoomConfig* plan() const { return m_plan ? &*m_plan : nullptr; }
  void setPlan(RoomConfig plan) { m_plan = std::move(plan); }
  RoomSleepState& sleep() { return m_sleep; }
  const RoomSleepState& sleep() const { return m_sleep; }
  bool isAsleep() const { return m_sleep.asleep; }
  /// True if the world must not tick: the room sleeps or stands still, or its round is being replayed.
  bool isPaused() const { return m_sleep.asleep || m_sleep.still || m_p_round->recovering(); }

  // Players.

  /// Adds a player to the world in its next tick. add() adds their session to the room.
  void join(std::uint32_t player, const std::string& name, df::Color color) {
    m_p_round->addInput({.kind = df::InputQueue::kJoin, .player = player, .name = name, .color = color});
  }
  /// Removes the player from the world in its next tick.
  void leave(std::uint32_t player) {
    m_p_round->addInput({.kind = df::InputQueue::kLeave, .player = player});
  }
  /// Adds a session that was welcomed to this room.
  void add(Session& session);
  /// Removes a session that is about to be destroyed or to move to another room, if it is in this room.
  void remove(const Session& session);
  /// Stops this room's music and loops at the client of a session that is about to move to another room.
  void stopSounds(const Session& session) { m_sound_broadcaster.stopFor(session.player(), soundSender()); }
  bool has(const Session& session) const;
  /// Returns null if the player does not play here.
  Session* find(std::uint32_t player) const;
  bool isEmpty() const;
  std::size_t countPlaying() const;
  /// Calls `visit(session)` for all playing sessions, by player id.
  template <class Visit>
  void forEachPlaying(Visit visit) const {
    for (Session* p_session : m_members) {
      if (p_session->state() == Session::State::kPlaying) visit(*p_session);
    }
  }
  /// Calls `visit(session, facts)` for all playing sessions whose player is in the world's last view, by
  /// player id. Players that the world reports and that have no such session are skipped.
  template <class Visit>
  void forEachInWorld(Visit visit) const {
    const std::vector<df::PlayerFacts>& players = m_p_round->view().players;
    auto found = players.begin();
    forEachPlaying([&](Session& session) {
      while (found != players.end() && found->id < session.player()) ++found;  // both are sorted by id
      if (found != players.end() && found->id == session.player()) visit(session, *found);
    });
  }
  /// Sends a chat line from the server to all players.
  void broadcast(const std::string& text) const;
  /// Sends the playing sounds again to a player whose client may have missed some.
  void repeatSounds(std::uint32_t player) { m_sound_broadcaster.repeat(player); }
  const SoundBroadcaster& sounds() const { return m_sound_broadcaster; }
  /// Ends all players' sessions. Their clients try to reconnect for the time `again`; 0: they exit.
  void disconnectAll(const std::string& sentence, std::chrono::seconds again = std::chrono::seconds(0)) const;

  // Ticks.

  /// Passes the players' input to the world and begins a tick. Returns false if the world is not ready.
  /// `truth`: whether publish() gets a TruthWriter. `audited_player`: player whose picture is audited, or 0.
  bool beginTick(bool truth, std::uint32_t audited_player = 0);
  /// Sends snapshots, sounds and notes after the world's tick. Writes pictures to `p_truth` unless null.
  void publish(TruthWriter* p_truth);
  /// True while a tick is running.
  bool isTicking() const { return m_ticking; }
  /// Number of the newest tick that began.
  std::uint32_t tick() const { return m_p_round->nextTick() - 1; }
  /// Number of published Objects; 0 without players.
  std::size_t objects() const { return m_watched ? m_publisher.liveCount() : 0; }
  /// Counts a tick of the host for which the world was not ready.
  void countLateTick() { ++m_late_ticks; }
  std::uint64_t lateTicks() const { return m_late_ticks; }
  /// Number of ticks of the current round that have ended.
  std::uint64_t ticks() const { return m_ticks; }
  /// Counts ticks of the current round that another server has played.
  void addTicks(std::uint64_t ticks) { m_ticks += ticks; }

  /// Counts a round that ended. Returns the number of consecutive short rounds.
  int countShortRounds(bool is_short) { return m_short_rounds = is_short ? m_short_rounds + 1 : 0; }
  /// Switches to another round: players join its world and get it from the start. Returns the old one.
  std::unique_ptr<Round> changeRound(std::unique_ptr<Round> round);

 private:
  void updateInputFocus();
  void announceInputFocus(Session& session) const;
  void applyInputs();
  void updateWatching();
  void sendSnapshots(TruthWriter* p_truth);
  SoundBroadcaster::Send soundSender() const;
  void sendNotes() const;

  std::unique_ptr<Round> m_p_round;
  StageClock& m_stages;
  Publisher m_publisher;
  SoundBroadcaster m_sound_broadcaster;
  std::vector<Session*> m_members;  ///< sorted by player id; includes ending sessions
  InputFocus m_input_focus;
  std::uint32_t m_audited_player = 0;  ///< player audited in the newest tick, or 0
  bool m_watched = false;
  bool m_ticking = false;
  std::uint64_t m_ticks = 0;
  std::uint64_t m_late_ticks = 0;
  std::optional<RoomConfig> m_plan;
  RoomSleepState m_sleep;
  int m_short_rounds = 0;
};

}  // namespace naiad
