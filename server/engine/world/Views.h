// The boundary, the window, the world's own view, and the players with theirs.
//
// A view is a corner; its size is the window's. A player shares the world's view until they first have an
// Object, and have their own from then on. A view that follows an Object moves only when that Object is moved
// by moveObject() or update(); setting it to follow centres it.
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

  /// Both live longer than this.
  Views(WorldStore& store, WorldLog& log) : m_store(store), m_log(log) { reset(); }
  /// As at the beginning: no players, window 80 by 24, boundary the window.
  void reset();

  // Boundary and window.

  int setBoundary(const Box& box);
  const FixedBox& boundary() const { return m_boundary; }
  /// Is this position in the world: corner included, far edges excluded?
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
  /// Count and log a call on a Player that was refused. Return -1.
  int refuse(const char* what);
  const WorldStore& store() const { return m_store; }

  // Views. A null player, and one without a view of their own, stand for the world's view.

  FixedVector cornerOf(const Player* p_player) const;
  Box viewOf(const Player* p_player) const;
  /// Put the corner there, clamped inside the boundary.
  void setCorner(Player* p_player, FixedVector corner);
  /// Centre the view on this position.
  void centre(Player* p_player, FixedVector position);
  /// Follow this Object from now on; null: none. Return 0, or -1 for one that is not in this world.
  int follow(Player* p_player, Object* p_o);
  /// Give the player a view of their own and follow this Object; null leaves the view where it is.
  int setObject(Player& player, Object* p_o);
  /// A followed Object was moved.
  void moved(ObjectKey key, FixedVector position);
  /// The Object that the player's view follows, their own or the world's; generation 0 if none.
  ObjectKey followed(const Player* p_player) const;
  /// All views, in whole cells: what shows on the screens.
  ViewCover cover() const;

 private:
  FixedVector size() const { return {fromCells(m_width), fromCells(m_height)}; }
  void clampAll();
  void indexFollowers();

  WorldStore& m_store;
  WorldLog& m_log;
  FixedBox m_boundary;
  bool m_boundary_set = false;  // else it follows the window
  int m_width = 0;
  int m_height = 0;
  FixedVector m_corner;  // of the world's view
  ObjectKey m_followed;  // by the world's view
  Players m_players;
  /// By the slot that a player's own view follows: players are many, and many Objects are followed.
  std::vector<std::pair<std::uint32_t, Player*>> m_followers;
  bool m_followers_known = false;
};

}  // namespace df
