// The book's world, written as plainly as the book prints it: the loop over all Objects against which the
// engine is compared, bit for bit. Nothing of the engine is used here but its number type.
//
// Listing 4.100 predictPosition, 4.101 update, 4.104 isSolid, 4.107 positionsIntersect (with boxes, section
// 4.13), 4.108 getCollisions, 4.109 moveObject, 4.111 no soft, 4.113 out of bounds; and two things that the
// listings leave open: an Object that a handler deletes is passed over wherever a list still names it, and an
// inactive one gets no events.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "Fixed.h"
#include "Solidness.h"

namespace oracle {

using df::Fixed;
using df::FixedBox;
using df::FixedVector;
using df::Solidness;

/// A single character: one cell, centred on the position.
inline constexpr FixedBox kCharacterBox{{-df::kFixedOne / 2, -df::kFixedOne / 2},
                                        {df::kFixedOne, df::kFixedOne}};

/// An Object of the book, without a look.
struct Object {
  int id = 0;
  FixedVector position;
  FixedVector velocity;
  FixedVector acceleration;
  FixedBox box = kCharacterBox;  ///< relative to the position
  Solidness solidness = df::HARD;
  bool no_soft = false;
  bool active = true;
  bool gone = false;  ///< deleted or removed from the world; only lists made before still point here

  bool isSolid() const { return solidness == df::HARD || solidness == df::SOFT; }
  FixedVector predictPosition() const { return position + velocity; }
  /// In cells per tick: the direction is the normalised vector, the speed its length, the velocity their
  /// product.
  void setVelocity(double x, double y);
};

using ObjectList = std::vector<Object*>;

/// Do the two boxes, in world coordinates, overlap or touch? (Listing 4.107, for boxes.)
bool boxIntersectsBox(const FixedBox& a, const FixedBox& b);

/// What the Objects of a world do about events: their eventHandler()s.
class Handlers {
 public:
  virtual ~Handlers() = default;
  virtual void step(Object* p_receiver) = 0;
  /// `p_obj1` caused the collision by moving to `where`, onto `p_obj2`.
  virtual void collision(Object* p_receiver, Object* p_obj1, Object* p_obj2, FixedVector where) = 0;
  virtual void out(Object* p_receiver) = 0;
  /// The Object is going: its destructor.
  virtual void destroyed(Object* p_o) = 0;
};

/// What happened so far, to show that a test met every case.
struct Counters {
  std::int64_t moves = 0;         ///< calls of moveObject, by update and by handlers
  std::int64_t nested_moves = 0;  ///< of those: from a handler of another move
  std::int64_t too_deep = 0;      ///< of those: refused for the depth
  std::int64_t blocked_hard = 0;  ///< of those: refused, HARD onto HARD
  std::int64_t blocked_soft = 0;  ///< of those: refused, no soft onto SOFT
  std::int64_t met_soft = 0;      ///< of those: met with SOFT, as mover or as other
  std::int64_t outs = 0;          ///< of those: sent an out event
  std::int64_t collisions = 0;    ///< pairs of mover and other that were sent collision events
};

class World {
 public:
  /// At most this many moveObject()s at once, one within a handler of the other.
  static constexpr int kDeepestMove = 32;

  /// `handlers` must outlive the world.
  World(const FixedBox& boundary, Handlers& handlers) : m_boundary(boundary), m_handlers(handlers) {}

  /// A new Object at the end of the list.
  Object* create(int id);
  /// Deletion at the end of the next update; twice is once.
  void markForDelete(Object* p_o);
  /// What `delete p_o` does: gone at once.
  void destroy(Object* p_o);
  /// Take out without deleting. Lists made before, and the mark for deletion, forget it.
  void remove(Object* p_o);
  /// Put a removed Object back, at the end of the list. Return what it is from now on.
  Object* insert(const Object* p_o);

  /// The step event, to all Objects that there are when it begins.
  void step();
  /// All moves, then all deletions.
  void update();
  int moveObject(Object* p_o, FixedVector where);
  ObjectList getCollisions(const Object* p_o, FixedVector where) const;

  /// In creation order.
  const ObjectList& getAllObjects() const { return m_updates; }
  const Counters& counters() const { return m_counters; }

 private:
  int moveNow(Object* p_o, FixedVector where);
  bool isInside(FixedVector position) const;

  FixedBox m_boundary;
  Handlers& m_handlers;
  ObjectList m_updates;
  ObjectList m_deletions;
  int m_depth = 0;
  Counters m_counters;
  std::vector<std::unique_ptr<Object>> m_memory;  ///< every Object that ever was, so that no pointer dangles
};

}  // namespace oracle
