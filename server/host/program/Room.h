// Those who play in one world, that world, and what they have been told of it.
//
// A host has one room, or one for each player (HostOptions::players). Sessions belong to the host; a room
// knows those that play in it, and forgets them when it is told to.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "host/program/SoundNews.h"
#include "host/session/Session.h"
#include "host/snapshot/Publisher.h"
#include "host/world/WorldPort.h"
#include "shared/replica/TruthFile.h"

namespace naiad {

class Room {
 public:
  /// `first_only`: of several players, only the first one's keys are heard.
  Room(std::unique_ptr<WorldPort> port, bool first_only);
  Room(const Room&) = delete;
  Room& operator=(const Room&) = delete;

  WorldPort& port() { return *m_p_port; }
  const WorldPort& port() const { return *m_p_port; }

  // Players.

  /// The world's next tick makes a player of this name; he belongs to the room with add(). Return his id.
  std::uint32_t join(std::uint32_t player, const std::string& name, df::Color color) {
    return m_p_port->join(player, name, color);
  }
  /// He was welcomed. Players are added in the order of their ids.
  void add(Session& session);
  /// Forget the session, if it is one of this room's: it is about to be destroyed.
  void remove(const Session& session);
  bool has(const Session& session) const;
  /// Null if he does not play here.
  Session* find(std::uint32_t player) const;
  bool isEmpty() const;
  /// Call `visit(session)` for all that play, by player.
  template <class Visit>
  void forEachPlaying(Visit visit) const {
    for (Session* p_session : m_members) {
      if (p_session->state() == Session::State::kPlaying) visit(*p_session);
    }
  }
  /// A line from the server to all that play.
  void say(const std::string& text) const;
  /// The player may have missed what sounds: he is told anew what goes on.
  void repeatSounds(std::uint32_t player) { m_sound_news.repeat(player); }
  /// What was told of this world's sounds so far.
  const SoundNews& sounds() const { return m_sound_news; }
  /// End the sessions of all that play.
  void dismiss(const std::string& sentence) const;

  // Ticks.

  /// Hand on what the players did, and begin a tick if the world is ready for one. False: it is not. `truth`:
  /// publish() will have a TruthWriter.
  bool beginTick(bool truth);
  /// The world's tick has ended: tell everybody what is to be told. The truth goes to `p_truth`, if there is
  /// one.
  void publish(TruthWriter* p_truth);
  /// A tick has begun and not ended.
  bool isTicking() const { return m_ticking; }
  /// The newest tick that was told.
  std::uint32_t tick() const { return m_p_port->nextTick() - 1; }
  /// Ticks of the present world.
  std::uint64_t ticks() const { return m_ticks; }

  /// The world has ended; was its round a short one? Return how many have been in a row.
  int countShortRounds(bool is_short) { return m_short_rounds = is_short ? m_short_rounds + 1 : 0; }
  /// Another world: all who play join that, and are told it from the beginning.
  void changeWorld(std::unique_ptr<WorldPort> port);

 private:
  void giveTurn();
  void tellTurn(Session& session) const;
  bool tellSounds(std::uint32_t player, const wire::ServerMessage& message, bool lasts) const;
  SoundNews::Tell soundTeller() const;
  void tellNotes() const;
  bool isHeard(const Session& session, const Input& input) const;
  void applyInputs();

  std::unique_ptr<WorldPort> m_p_port;
  Publisher m_publisher;
  SoundNews m_sound_news;
  std::vector<Session*> m_members;  ///< by player; those that are ending among them
  bool m_first_only;
  bool m_watched = false;
  bool m_ticking = false;
  std::uint32_t m_turn = 0;         ///< the player whose input is heard, if only one's is; 0: nobody
  std::uint32_t m_turn_before = 0;  ///< whose was before him: keys that he held are let go
  std::uint64_t m_ticks = 0;
  int m_short_rounds = 0;
};

}  // namespace naiad
