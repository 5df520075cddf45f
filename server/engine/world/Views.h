// The boundary, the window, the world's own view, and the players with their views.
//
// A view is defined by its corner; its size is the window's. A player shares the world's view until they get
// their first Object (Player::setObject), and has their own view from then on. A view that follows an Object
// moves only when moveObject() or update() moves that Object; beginning to follow an Object centres the view.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/world/Player.h"
#include "engine/world/ViewCover.h"
#include "engine/world/WorldView.h"
#include "shared/values/Box.h"
#include "shared/values/Color.h"

namespace df {

class Object;
class WorldLog;
class WorldStore;

class Views {
 public:
  using Players = std::map<std::uint32_t, std::unique_ptr<Player>>;

  /// The arguments must outlive this object.
  Views(WorldStore& store, WorldLog& log) : m_store(store), m_log(log) { reset(); }
  /// Restores the initial state: no players, and a window and boundary of 80 by 24.
  void reset();

  // Boundary and window.

  int setBoundary(const Box& box);
  const FixedBox& boundary() const { return m_boundary; }
  /// True if the position is in the world: corner included, far edges excluded.
  bool isInside(FixedVector p) const {
    const FixedVector d = p - m_boundary.corner;
    return d.x >= 0 && d.y >= 0 && d.x < m_boundary.size.x && d.y < m_boundary.size.y;
  }
  int setWindow(int width, int height);
  int width() const { return m_width; }
  int height() const { return m_height; }

  // Players.

  Player* addPlayer(std::uint32_t id, const std::string& name, Color color);
  void removePlayer(std::uint32_t id);
  Player* player(std::uint32_t id) const;
  const Players& players() const { return m_players; }
  std::vector<Player*> getPlayers() const;
  /// Counts and logs a refused call of a Player's function. Returns -1.
  int refuse(const char* what);
  const WorldStore& store() const { return m_store; }

  // Views. A null player, or a player without their own view, stands for the world's view.

  FixedVector cornerOf(const Player* p_player) const;
  Box viewOf(const Player* p_player) const;
  /// Moves the view to this corner, clamped inside the boundary.
  void setCorner(Player* p_player, FixedVector corner);
  /// Centres the view on this position.
  void centre(Player* p_player, FixedVector position);
  /// Makes the view follow this Object; null: none. Returns 0, or -1 for an Object that is not in this world.
  int follow(Player* p_player, Object* p_o);
  /// Makes the player steer this Object, and gives them their own view, which follows it. For null, the
  /// player steers no Object, and their own view, if any, stays where it is. Returns like follow().
  int setObject(Player& player, Object* p_o);
  /// Moves the views that follow this Object. Call when the Object was moved.
  void moved(ObjectKey key, FixedVector position);
  /// Returns the Object that the player's view (their own or the world's) follows; generation 0 if none.
  ObjectKey followed(const Player* p_player) const;
  /// Returns all views, in whole cells, as the screens show them.
  ViewCover cover() const;

 private:
  FixedVector size() const { return {fromCells(m_width), fromCells(m_height)}; }
  void clampAll();
  void indexFollowers();

  WorldStore& m_store;
  WorldLog& m_log;
  FixedBox m_boundary;
  bool m_boundary_set = false;  // false: the boundary is the window
  int m_width = 0;
  int m_height = 0;
  FixedVector m_corner;  // corner of the world's view
  ObjectKey m_followed;  // Object that the world's view follows
  Players m_players;
  /// The players whose own view follows an Object, each with the slot of the Object, so that moved() need not
  /// search all players.
  std::vector<std::pair<std::uint32_t, Player*>> m_followers;
  bool m_followers_known = false;
};

}  // namespace df
