// A person (or bot) at a terminal. Games for several players read and set these; other games ignore them and
// get all players' keys.
//
// A Player exists from its EventJoin until just after its EventLeave; `WM.getPlayer(id)` is null outside
// that. Ids count up from 1 and are not used again in a world. All calls on the thread that runs the tick.
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

// In a namespace of its own, so that a game with `using namespace df` that never includes this may have a
// Player class itself: many do.
namespace players {
class Player;
}

namespace players {

class Player {
 public:
  /// For the engine, which makes players as they join.
  Player(Views& views, std::uint32_t id, std::string name, Color color);

  /// The player's number: 1, 2, …, each once in a world.
  std::uint32_t getId() const { return m_id; }
  /// As the player gave it; the host makes sure that it can be drawn.
  const std::string& getName() const { return m_name; }
  /// The player's colour: seven take turns, so that the first seven players differ.
  Color getColor() const { return m_color; }

  /// The Object this player steers; null after its deletion. The view follows it from now on
  /// (WM.setViewFollowing, while the player's input is handled, lets it follow another).
  /// Passing null leaves the view where it is. Return 0, or -1 for an Object of another world.
  int setObject(Object* p_o);
  Object* getObject() const;

  /// From now on these keys move getObject(), whichever that is at the time (Controls.h); a table without
  /// rows ends it. Keys held down and waits are forgotten. Return 0, or -1 for controls with a number that
  /// is not finite or out of range (nothing changes).
  int setControls(const Controls& controls);
  /// Whether the controls have effects (default), or only remember which keys are down: while a ship is
  /// lost, say. An Object that is inactive is not moved either.
  void setSteering(bool steering = true) { m_steers = steering; }
  bool isSteering() const { return m_steers; }

  /// Points, shown in the client's player list.
  void setScore(int score) { m_score = score; }
  int getScore() const { return m_score; }

  /// Show `text` to this player only, at cell `position` of the player's view, under number `id`
  /// (0 to 15); an empty text removes it. Characters that no terminal draws in one cell become '?'.
  /// Return 0, or -1 for an id, position or colour out of range (nothing changes).
  int setText(std::uint32_t id, Vector position, const std::string& text, Color color = COLOR_DEFAULT);

  /// Upper left corner of this player's view, in world coordinates.
  Vector getViewCorner() const { return Vector::fromFixed(m_view_corner); }

  /// The plain-data form, for the host.
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
  ObjectKey m_object;    // steered
  ObjectKey m_followed;  // by the view, once it is the player's own
  FixedVector m_view_corner;
  bool m_has_view = false;  // since its first Object; before that it shares the world's view
  std::map<std::uint32_t, PlayerText> m_texts;
  std::shared_ptr<const ControlTable> m_p_controls;  // null: none declared
  ControlState m_control_state;
  bool m_steers = true;
};

}  // namespace players

using players::Player;

}  // namespace df
