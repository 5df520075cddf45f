// A world, the players in it, and what they have been sent of it.
//
// A host has one room, or one for each player (HostOptions::players). Sessions belong to the host; a room
// lists those that play in it until remove().
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "host/process/StageClock.h"
#include "host/rooms/SoundNews.h"
#include "host/rounds/RoomPlan.h"
#include "host/rounds/Round.h"
#include "host/session/Session.h"
#include "host/snapshot/Publisher.h"
#include "shared/replica/TruthFile.h"
#include "shared/replica/UpdateCodec.h"
#include "shared/values/Keyboard.h"

namespace naiad {

/// Which player's input reaches the game, if only one player's does (HostOptions::players, "first").
class InputTurn {
 public:
  explicit InputTurn(bool first_only) : m_first_only(first_only) {}

  bool isOneOnly() const { return m_first_only; }
  /// Whose turn it is; 0: no player's.
  std::uint32_t player() const { return m_player; }
  /// It is this player's turn. True: it was another player's before.
  bool passTo(std::uint32_t player) {
    if (player == m_player) return false;
    m_before = std::exchange(m_player, player);
    return player != 0 && m_before != 0;
  }
  /// Keys that the player before still holds may be released.
  bool isHeard(std::uint32_t player, const Input& input) const {
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
  /// `first_only`: of several players, only the first one's input is heard. `stages`: measures what a tick
  /// does; outlives the room.
  Room(std::unique_ptr<Round> round, bool first_only, StageClock& stages);
  Room(const Room&) = delete;
  Room& operator=(const Room&) = delete;

  /// What is played: a room that sleeps has a SleepingWorld.
  Round& round() { return *m_p_round; }
  const Round& round() const { return *m_p_round; }

  // Its name.

  /// Null: it has none (--room was not given).
  const RoomPlan* plan() const { return m_plan ? &*m_plan : nullptr; }
  void setPlan(RoomPlan plan) { m_plan = std::move(plan); }
  RoomSleep& sleep() { return m_sleep; }
  const RoomSleep& sleep() const { return m_sleep; }
  bool isAsleep() const { return m_sleep.asleep; }
  /// Its world is not to tick: it sleeps, stands still, or its round is being executed again.
  bool rests() const { return m_sleep.asleep || m_sleep.still || m_p_round->recovering(); }

  // Players.

  /// The world's next tick makes a player of this name; add() makes their session one of the room's.
  void join(std::uint32_t player, const std::string& name, df::Color color) {
    m_p_round->addInput({.kind = df::InputQueue::kJoin, .player = player, .name = name, .color = color});
  }
  /// The player leaves the world in its next tick.
  void leave(std::uint32_t player) {
    m_p_round->addInput({.kind = df::InputQueue::kLeave, .player = player});
  }
  /// The session was welcomed. Sessions are added in the order of their players' ids.
  void add(Session& session);
  /// The session, if it is one of this room's, is about to be destroyed.
  void remove(const Session& session);
  /// The session, which plays here, is about to go to another room: its client is not to go on with this
  /// one's music.
  void stopSounds(const Session& session) { m_sound_news.stopFor(session.player(), soundSender()); }
  bool has(const Session& session) const;
  /// Null if the player does not play here.
  Session* find(std::uint32_t player) const;
  bool isEmpty() const;
  std::size_t countPlaying() const;
  /// Call `visit(session)` for all that play, by player.
  template <class Visit>
  void forEachPlaying(Visit visit) const {
    for (Session* p_session : m_members) {
      if (p_session->state() == Session::State::kPlaying) visit(*p_session);
    }
  }
  /// Call `visit(session, facts)` for all that play and are in the world's last view, by player. Others whom
  /// the world reports are left out.
  template <class Visit>
  void forEachInWorld(Visit visit) const {
    const std::vector<df::PlayerFacts>& players = m_p_round->view().players;
    auto found = players.begin();
    forEachPlaying([&](Session& session) {
      while (found != players.end() && found->id < session.player()) ++found;  // both are in order
      if (found != players.end() && found->id == session.player()) visit(session, *found);
    });
  }
  /// A line from the server to all that play.
  void say(const std::string& text) const;
  /// The player's client may have missed sounds: send again what is playing.
  void repeatSounds(std::uint32_t player) { m_sound_news.repeat(player); }
  const SoundNews& sounds() const { return m_sound_news; }
  /// End the sessions of all that play. `again`: for so long their clients look for the server; 0: they end.
  void dismiss(const std::string& sentence, std::chrono::seconds again = std::chrono::seconds(0)) const;

  // Ticks.

  /// Pass on the players' input, and begin a tick if the world is ready for one. False: it is not. `truth`:
  /// publish() will have a TruthWriter. `pictured`: the player whose picture is audited; 0: none.
  bool beginTick(bool truth, std::uint32_t pictured = 0);
  /// The world's tick has ended: send snapshots, sounds and notes. The truth goes to `p_truth`, if there is
  /// one.
  void publish(TruthWriter* p_truth);
  /// A tick has begun and not ended.
  bool isTicking() const { return m_ticking; }
  /// The newest tick that was begun.
  std::uint32_t tick() const { return m_p_round->nextTick() - 1; }
  /// Objects that are published; 0 without players.
  std::size_t objects() const { return m_watched ? m_publisher.liveCount() : 0; }
  /// A tick of the host began, and the world was not ready for one.
  void noteLate() { ++m_late_ticks; }
  std::uint64_t lateTicks() const { return m_late_ticks; }
  /// Ticks of the present world.
  std::uint64_t ticks() const { return m_ticks; }

  /// The world has ended. Return how many short rounds there have been in a row.
  int countShortRounds(bool is_short) { return m_short_rounds = is_short ? m_short_rounds + 1 : 0; }
  /// Go on with another round: all players join its world, and are sent it from the beginning. Return the one
  /// before.
  std::unique_ptr<Round> changeRound(std::unique_ptr<Round> round);

 private:
  void passTurn();
  void announceTurn(Session& session) const;
  void applyInputs();
  void sendSnapshots(TruthWriter* p_truth);
  SoundNews::Send soundSender() const;
  void sendNotes() const;

  std::unique_ptr<Round> m_p_round;
  StageClock& m_stages;
  Publisher m_publisher;
  SoundNews m_sound_news;
  std::vector<Session*> m_members;  ///< by player; those that are ending among them
  InputTurn m_turn;
  std::uint32_t m_pictured = 0;  ///< in the tick that was begun last
  bool m_watched = false;
  bool m_ticking = false;
  std::uint64_t m_ticks = 0;
  std::uint64_t m_late_ticks = 0;
  std::optional<RoomPlan> m_plan;
  RoomSleep m_sleep;
  int m_short_rounds = 0;
};

}  // namespace naiad
