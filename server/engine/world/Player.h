// A person (or bot) at a terminal. Games for one player ignore Players and get all players' keys.
//
// A Player exists from its EventJoin until just after its EventLeave. Otherwise `WM.getPlayer(id)` is null.
// Ids count up from 1 and are not reused in a world. All calls must be on the thread that runs the tick.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>

#include "ControlTable.h"
#include "Object.h"
#include "Vector.h"
#include "detail/WorldView.h"

namespace df {

class ControlApplier;
class Controls;
class Views;

// Player has a namespace of its own, so that a game with `using namespace df` that never includes this header
// may have a Player class itself, as many do.
namespace players {
class Player;
}

namespace players {

class Player {
 public:
  /// The engine makes a Player when a player joins.
  Player(Views& views, std::uint32_t id, std::string name, Color color);

  /// Returns the player's number: 1, 2, …, unique in a world.
  std::uint32_t getId() const { return m_id; }
  /// Returns the name that the player gave; the host makes sure that it can be drawn.
  const std::string& getName() const { return m_name; }
  /// Returns the player's colour. Seven colours take turns, so that the first seven players differ.
  Color getColor() const { return m_color; }

  /// Object that this player steers; null after its deletion. setObject() makes the player's view follow the
  /// Object (to follow another, call WM.setViewFollowing() while the player's input is being handled); null
  /// leaves the view where it is. setObject() returns 0, or -1 for an Object of another world.
  int setObject(Object* p_o);
  Object* getObject() const;

  /// Makes the keys in `controls` move the Object that getObject() returns at the time (Controls.h). Controls
  /// without rows end this. Keys held down and waits are reset. Returns 0, or -1 without change for invalid
  /// controls (Controls::table).
  int setControls(const Controls& controls);
  /// Whether the controls have effects (default) or only record which keys are down, for example while a ship
  /// is lost. An inactive Object is not moved, either.
  void setSteering(bool steering = true) { m_steers = steering; }
  bool isSteering() const { return m_steers; }

  /// Points, shown in the client's player list.
  void setScore(int score) { m_score = score; }
  int getScore() const { return m_score; }

  /// Shows `text` to this player only, at cell `position` of the player's view, under number `id` (0 to 15);
  /// an empty text removes it. Characters that no terminal draws in one cell become '?'; those beyond the
  /// right edge of the view are dropped. Returns 0, or -1 without change for an id, position or colour out of
  /// range.
  int setText(std::uint32_t id, Vector position, const std::string& text, Color color = COLOR_DEFAULT);

  /// Returns the upper left corner of this player's view, in world coordinates.
  Vector getViewCorner() const { return Vector::fromFixed(m_view_corner); }

  /// Returns the player's state as plain data, for the host.
  PlayerFacts facts() const;

 private:
  SteeringFacts steeringFacts() const;

  friend class df::ControlApplier;
  friend class df::Views;
  Views& m_views;
  std::uint32_t m_id;
  std::string m_name;
  Color m_color;
  int m_score = 0;
  ObjectKey m_object;    // steered Object
  ObjectKey m_followed;  // Object that the player's own view follows
  FixedVector m_view_corner;
  bool m_has_view = false;  // true since setObject() got an Object; false: shares the world's view
  std::map<std::uint32_t, PlayerText> m_texts;
  std::shared_ptr<const ControlTable> m_p_controls;  // null: no controls
  ControlState m_control_state;
  bool m_steers = true;
};

}  // namespace players

using players::Player;

}  // namespace df
