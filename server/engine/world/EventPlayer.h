// Events of players that join or leave, sent to Objects that registered interest in JOIN_EVENT or
// LEAVE_EVENT, in the input stage of a tick. A game that registers for neither still has players: they watch,
// and the game gets their keys.
#pragma once

#include <cstdint>

#include "Event.h"
#include "Player.h"

namespace df {

/// Register interest in these types to get an EventJoin or EventLeave for each player.
inline const EventType JOIN_EVENT("df-join");
inline const EventType LEAVE_EVENT("df-leave");

/// Sent when a player has joined: `WM.getPlayer(getPlayer())` exists from this event on.
class EventJoin : public Event {
 public:
  explicit EventJoin(std::uint32_t player = 0) : m_player(player) { setType(JOIN_EVENT); }
  /// Id of the player that joined.
  void setPlayer(std::uint32_t player) { m_player = player; }
  std::uint32_t getPlayer() const { return m_player; }

 private:
  std::uint32_t m_player;
};

/// Sent when a player leaves: the last event in which `WM.getPlayer(getPlayer())` exists. The game has to
/// delete the player's Object. An Object marked for deletion still gets events later in the tick, when the
/// Player is gone, so it should store the player's id, not the pointer.
class EventLeave : public Event {
 public:
  explicit EventLeave(std::uint32_t player = 0) : m_player(player) { setType(LEAVE_EVENT); }
  /// Id of the player that leaves.
  void setPlayer(std::uint32_t player) { m_player = player; }
  std::uint32_t getPlayer() const { return m_player; }

 private:
  std::uint32_t m_player;
};

}  // namespace df
