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
  /// What an Object would collide with: an ObjectList, and true if there is anything in it. Up to 4.14 the
  /// published engine returned the list, since then the answer; it is both.
  class Collisions : public ObjectList {
   public:
    explicit Collisions(ObjectList found) : ObjectList(std::move(found)) {}
    operator bool() const { return !isEmpty(); }
  };

  /// The one there is; WM is short for it. It acts on the current world.
  static WorldManager& getInstance();

  /// Delete the Objects that are alive and were made with `new`, take out the others, and set everything
  /// back, so that the world can be started again. Inside a tick or an event handler: at its end.
  void shutDown() override;

  // The Objects in the world.

  /// Put a removed Object back, as the last in creation order. (The constructor does the first insertion;
  /// for an Object that is in the world nothing happens.) Return 0, or -1 for null or an Object of another
  /// world.
  int insertObject(Object* p_o);
  /// Take an Object out without deleting it; lists and interests forget it at once. Return 0, or -1 if
  /// it is not in the world.
  int removeObject(Object* p_o);
  /// Delete at the end of the present or next update(), in order of the marks; until then it moves,
  /// collides and gets events as before. Twice is once. An Object not made with `new` is only taken out.
  /// Return 0, or -1 if it is not in the world.
  int markForDelete(Object* p_o);
  /// All in the list. Return 0, or -1 if one of them is not in the world.
  int markForDelete(const ObjectList& obj_list);
  /// All active Objects (and the inactive ones, if asked) in creation order.
  ObjectList getAllObjects(bool inactive = false) const;
  /// All active Objects of this type, in creation order.
  ObjectList objectsOfType(const std::string& type) const;
  /// All active HARD and SOFT Objects, in creation order.
  ObjectList solidObjects() const;
  /// The Object with this id (Object::getId); null if there is none.
  Object* objectWithId(int id) const;
  /// The active Objects whose boxes contain this position, edges included; in creation order, as those below.
  ObjectList objectsAtPosition(Vector where) const;
  /// Those whose boxes touch a box, a line segment, a circle.
  ObjectList objectsInBox(Box box) const;
  ObjectList objectsOnLine(Line line) const;
  ObjectList objectsInCircle(Circle circle) const;
  /// Lists of Objects by what they are.
  SceneGraph& getSceneGraph() const;
  /// The active visible Objects whose boxes covered this cell (a world position, as of EventMouse) on the
  /// screen of the player whose input is being handled, at the moment of that input, in creation order. For
  /// games in which a click must hit what was clicked on, whatever the latency and the target's speed.
  /// Outside a player's mouse input, and without setLookingBack(): those that cover it now. It goes at most 8
  /// ticks back (a quarter of a second).
  ObjectList objectsSeenAt(Vector cell) const;
  /// Have the host keep where Objects were drawn, for objectsSeenAt(), and where players' views were:
  /// then the position of an EventMouse is what was under the pointer in that picture. Off by default.
  void setLookingBack(bool looking_back = true);
  bool isLookingBack() const;

  /// A host stops the world's time once nobody has played in it for a minute, until the next player joins,
  /// unless this is true. Call before GM.run(). Off by default; without a host it means nothing.
  void setRunsEmpty(bool runs_empty = true);
  bool getRunsEmpty() const;

  // How they move.

  /// The active solid Objects whose boxes touch p_o's box if p_o were at `where`, in creation order,
  /// without p_o itself; where one of the two is precise, the characters must share a cell, too. Whether p_o
  /// is solid does not matter (Listing 4.108). Empty for null and for a position out of range.
  ObjectList getCollisions(const Object* p_o, Vector where) const;
  /// Would p_o collide at `where`, and with what?
  Collisions isCollision(const Object* p_o, Vector where) const;
  /// Move p_o to `where` (Listings 4.109, 4.111, 4.113): solid Objects it touches there and itself get
  /// collision events; if none blocks, it moves, and gets an out event if it left the world. Return 0 if it
  /// moved; -1 if blocked, deleted by a handler, not in the world, out of range, or nested more than 32 deep
  /// in handlers. An inactive Object is placed without collisions or events. Mover.h has the details.
  int moveObject(Object* p_o, Vector where);
  /// The first Object that p_o, if it is solid, would hit on the straight path to `where`, by the rules of
  /// swept moves, whether or not p_o is swept (docs/collisions.md): nothing moves, no event is sent. None for
  /// null, for an Object that is SPECTRAL, inactive or in no world, and for a position out of range.
  Contact firstContact(const Object* p_o, Vector where) const;
#if __cplusplus >= 201703L
  /// The position nearest to `near`, a whole number of cells from it on each axis, at which `box` (relative
  /// to the position, as in Object::setBox) touches no solid Object and lies inside the boundary; of equally
  /// near ones the one with the least y, then x. Nothing if there is none within 1000 cells, or if an
  /// argument is out of range.
  std::optional<Vector> findFree(Box box, Vector near) const;
#endif
  /// All moves of all Objects are swept from now on (Object::setSwept), or only those of the Objects that
  /// ask for it: the default.
  void setSweptCollisions(bool swept = true);
  bool getSweptCollisions() const;
  /// Move every active Object by its velocity, once, then delete what is marked. Nothing else of a tick
  /// happens; see GM.tick().
  void update();
  /// Draw all Objects in view. GM.tick() does it.
  void draw();

  // What is seen of it.

  /// The limits of the world, for out events and views; the window, if never set. Corner and size up to
  /// 1e6 cells. Return 0, else -1.
  int setBoundary(Box new_boundary);
  Box getBoundary() const;
  /// The view: that of the player whose input is being handled, if they have one of their own, else the
  /// world's, which all other players share. Its size is the window's (DM.setSize).
  Box getView() const;
  /// Move the view to the box's corner, clamped inside the boundary; the box's size is ignored. Return
  /// 0, or -1 if not finite.
  int setView(Box new_view);
  /// Centre the view on this position, clamped inside the boundary. Return 0, or -1 if not finite.
  int setViewPosition(Vector view_pos);
  /// Centre the view on this Object and move it along when moveObject() or update() take the Object out of
  /// the view's inner third. Null: stay. Return 0, or -1 if the Object is not in the world.
  int setViewFollowing(Object* p_new_view_following);
  /// The Object that the view follows; null for none.
  Object* getViewFollowing() const;
  /// Views that follow keep their Object in the inner third, whatever is set here; the published engine takes
  /// fractions of the view. Kept for getViewSlack().
  void setViewSlack(Vector new_slack);
  Vector getViewSlack() const;

  // Players.

  /// All players, by id. The pointers are good until the players leave.
  std::vector<players::Player*> getPlayers() const;
  /// The player with this id; null before its EventJoin and after its EventLeave.
  players::Player* getPlayer(std::uint32_t id) const;

  /// 0 to n-1, each equally likely, from the world's seed (GM.setSeed); 0 if n < 1. Unlike rand(), the same
  /// in every run with the same inputs.
  int randomInt(int n);

 private:
  WorldManager();
};

}  // namespace df
