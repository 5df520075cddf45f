// The game's own events. Its parts register interest in them, as in the engine's events, so they need not
// know each other's classes.
#pragma once

#include <cstdint>
#include <string>
#include <utility>

#include "Event.h"

inline const std::string ROUND_EVENT = "round";
inline const std::string NUKE_EVENT = "nuke";
inline const std::string SHOT_DOWN_EVENT = "shot-down";
inline const std::string SHIP_LOST_EVENT = "ship-lost";

/// Sent when another part of the round begins.
class EventRound : public df::Event {
 public:
  enum Part {
    TITLE,   ///< waiting for a player to begin
    FLYING,  ///< all players have ships
    OVER,    ///< all ships are lost
  };
  explicit EventRound(Part part) : m_part(part) { setType(ROUND_EVENT); }
  Part getPart() const { return m_part; }

 private:
  Part m_part;
};

/// Sent when a player uses a nuke: all enemies on the screen explode.
class EventNuke : public df::Event {
 public:
  EventNuke() { setType(NUKE_EVENT); }
};

/// Sent when a bullet of `player` has hit a saucer worth `points`.
class EventShotDown : public df::Event {
 public:
  EventShotDown(std::uint32_t player, int points) : m_player(player), m_points(points) {
    setType(SHOT_DOWN_EVENT);
  }
  std::uint32_t getPlayer() const { return m_player; }
  int getPoints() const { return m_points; }

 private:
  std::uint32_t m_player;
  int m_points;
};

/// Sent when a ship is lost, perhaps the pilot's last. Its pilot `name` has earned `points` in this round.
class EventShipLost : public df::Event {
 public:
  EventShipLost(std::string name, int points, bool is_last)
      : m_name(std::move(name)), m_points(points), m_is_last(is_last) {
    setType(SHIP_LOST_EVENT);
  }
  const std::string& getName() const { return m_name; }
  int getPoints() const { return m_points; }
  bool isLast() const { return m_is_last; }

 private:
  std::string m_name;
  int m_points;
  bool m_is_last;
};
