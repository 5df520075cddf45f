// Manages the Objects of the current world: which are in it, how they move, what they collide with (book,
// Listings 4.54, 4.101, 4.106, 4.130).
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "Box.h"
#include "Circle.h"
#include "Contact.h"
#include "Line.h"
#include "Manager.h"
#include "Object.h"
#include "ObjectList.h"
#include "ObjectListIterator.h"
#include "SceneGraph.h"
#include "StandardHeaders.h"
#include "Vector.h"

/// The world manager.
#define WM df::WorldManager::getInstance()

namespace df {

namespace players {
class Player;  // Player.h
}

class WorldManager : public Manager {
 public:
  /// Result of isCollision(): an ObjectList that converts to true if it is not empty. The published engine
  /// returned a list up to version 4.14, and a bool since then.
  class Collisions : public ObjectList {
   public:
    explicit Collisions(ObjectList found) : ObjectList(std::move(found)) {}
    operator bool() const { return !isEmpty(); }
  };

  /// Returns the only instance; WM is short for it. It acts on the current world.
  static WorldManager& getInstance();

  /// Deletes the Objects that were made with `new`, removes all others, and resets the rest of the world, so
  /// that it can be started again. If called inside a tick or an event handler, does so at its end.
  void shutDown() override;

  // Objects in the world.

  /// Puts a removed Object back into the world, last in creation order. (The constructor inserts new
  /// Objects.) Ignores Objects in the world. Returns 0, or -1 for null or an Object of another world.
  int insertObject(Object* p_o);
  /// Removes an Object from the world without deleting it. At once its interests end and lists read it as
  /// null. Returns 0, or -1 if it is not in the world.
  int removeObject(Object* p_o);
  /// Deletes the Object at the end of the present or next update(). Until then it moves, collides and gets
  /// events as before. Objects are deleted in the order in which they were marked; a second mark has no
  /// effect. An Object not made with `new` is only removed. Returns 0, or -1 if it is not in the world.
  int markForDelete(Object* p_o);
  /// Marks all Objects in the list. Returns 0, or -1 if one of them is not in the world.
  int markForDelete(const ObjectList& obj_list);
  /// Returns all active Objects and, if `inactive`, the inactive ones, in creation order.
  ObjectList getAllObjects(bool inactive = false) const;
  /// Returns all active Objects of this type, in creation order.
  ObjectList objectsOfType(const std::string& type) const;
  /// Returns all active HARD and SOFT Objects, in creation order.
  ObjectList solidObjects() const;
  /// Returns the Object with this id (Object::getId); null if not found.
  Object* objectWithId(int id) const;
  /// Returns the active Objects whose boxes contain this position, edges included, in creation order.
  ObjectList objectsAtPosition(Vector where) const;
  /// Returns the active Objects whose boxes touch this box, line segment or circle, in creation order.
  ObjectList objectsInBox(Box box) const;
  ObjectList objectsOnLine(Line line) const;
  ObjectList objectsInCircle(Circle circle) const;
  /// Returns the SceneGraph, whose functions list Objects by their properties.
  SceneGraph& getSceneGraph() const;
  /// Returns the active visible Objects whose boxes covered this cell (a world position, as in EventMouse) on
  /// the screen of the player whose input is being handled, at the moment of that input, in creation order.
  /// So a click hits the Object that the player saw there, whatever the latency and the Object's speed. Uses
  /// pictures of at most 8 ticks ago (a quarter of a second). Outside a player's mouse input, and without
  /// setLagCompensated(), uses the present positions.
  ObjectList objectsSeenAt(Vector cell) const;
  /// Makes the host record where Objects were drawn, for objectsSeenAt(), and where players' views were, so
  /// that the position of an EventMouse is the cell that the player saw under the pointer. Off by default.
  void setLagCompensated(bool lag_compensated = true);
  bool isLagCompensated() const;
  [[deprecated("say setLagCompensated")]] void setLookingBack(bool on = true) { setLagCompensated(on); }
  [[deprecated("say isLagCompensated")]] bool isLookingBack() const { return isLagCompensated(); }

  /// Whether a host continues to tick the world while it has no players. If not, ticks stop after a minute
  /// without players until the next player joins. Off by default. Call before GM.run(). Only hosts use it. A
  /// named room without players sleeps even so (--room-sleep): its world ends.
  void setRunsEmpty(bool runs_empty = true);
  bool getRunsEmpty() const;

  // Motion and collisions.

  /// Returns the active solid Objects whose boxes would touch p_o's box if p_o were at `where`, in creation
  /// order, without p_o itself; if one of the two is precise, the characters must share a cell, too. Whether
  /// p_o is solid does not matter (Listing 4.108). Empty for null and for a position out of range.
  ObjectList getCollisions(const Object* p_o, Vector where) const;
  /// Like getCollisions(), but the result converts to true if it is not empty.
  Collisions isCollision(const Object* p_o, Vector where) const;
  /// Moves p_o to `where` (Listings 4.109, 4.111, 4.113): the solid Objects that it touches there, and p_o
  /// itself, get collision events; if none blocks, it moves, and gets an out event if it left the world.
  /// Returns 0 if it moved; -1 if blocked, deleted by a handler, not in the world, out of range, or nested
  /// more than 32 deep in handlers. An inactive Object is placed without collisions or events. See Mover.h.
  int moveObject(Object* p_o, Vector where);
  /// Returns the first Object that p_o, if solid, would hit on the straight path to `where`, by the rules of
  /// swept moves (docs/collisions.md), whether or not p_o is swept. Nothing moves, no event is sent. Returns
  /// a Contact without Object if p_o is null, SPECTRAL, inactive or in no world, or `where` is out of range.
  Contact firstContact(const Object* p_o, Vector where) const;
#if __cplusplus >= 201703L
  /// Returns the position nearest to `near`, a whole number of cells from it on each axis, at which `box`
  /// (relative to the position, as in Object::setBox) touches no solid Object and lies inside the boundary;
  /// of equally near positions the one with the least y, then x. Nullopt if there is none within 1000 cells,
  /// or if an argument is out of range.
  std::optional<Vector> findFree(Box box, Vector near) const;
#endif
  /// Whether all Objects' moves are swept. By default only those of Objects with Object::setSwept() are.
  void setSweptCollisions(bool swept = true);
  bool getSweptCollisions() const;
  /// Moves every active Object by its velocity, once, including bodies, then deletes the marked Objects. Does
  /// nothing else that a tick does; see GM.tick().
  void update();
  /// Draws all Objects in view. GM.tick() calls it.
  void draw();

  // Boundary and view.

  /// Limits of the world, for out events and views. Default: the size of the window. Corner and size are up
  /// to 1e6 cells. setBoundary() returns 0, or -1 if a number is out of range.
  int setBoundary(Box new_boundary);
  Box getBoundary() const;
  /// Returns the view of the player whose input is being handled, if they have their own, else the world's
  /// view, which all players without their own share. Its size is the window's (DM.setSize).
  Box getView() const;
  /// Moves the view to the box's corner, clamped inside the boundary; the box's size is ignored. Returns 0,
  /// or -1 if a number is out of range.
  int setView(Box new_view);
  /// Centres the view on this position, clamped inside the boundary. Returns 0, or -1 if it is out of range.
  int setViewPosition(Vector view_pos);
  /// Centres the view on this Object, and moves it along when moveObject() or update() takes the Object out
  /// of the view's inner third. Null makes the view stay where it is. Returns 0, or -1 if the Object is not
  /// in the world.
  int setViewFollowing(Object* p_new_view_following);
  /// Returns the Object that the view follows; null for none.
  Object* getViewFollowing() const;
  /// Only stored for getViewSlack(): a view that follows an Object always keeps it in the inner third. In the
  /// published engine these are fractions of the view's size.
  void setViewSlack(Vector new_slack);
  Vector getViewSlack() const;

  // Players.

  /// Returns all players, by id. The pointers are valid until the players leave.
  std::vector<players::Player*> getPlayers() const;
  /// Returns the player with this id; null before its EventJoin and after its EventLeave.
  players::Player* getPlayer(std::uint32_t id) const;

  /// Returns a random number 0 to n-1, each equally likely, from the sequence of the world's seed
  /// (GM.setSeed); 0 if n < 1. Unlike rand(), it gives the same numbers in all runs with the same inputs.
  int randomInt(int n);

 private:
  WorldManager();
};

}  // namespace df
