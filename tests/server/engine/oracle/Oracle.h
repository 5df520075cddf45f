// The oracle: the book's world, written as plainly as in the book, with the options of docs/collisions.md. It
// tests all Objects in a loop. The engine is compared with it bit for bit. Of the engine it uses only the
// number type.
//
// Listing 4.100 predictPosition, 4.101 update, 4.104 isSolid, 4.107 positionsIntersect (with boxes, section
// 4.13), 4.108 getCollisions, 4.109 moveObject, 4.111 no soft, 4.113 out of bounds. The listings leave two
// cases open: here, lists skip an Object that a handler deleted, and an inactive Object gets no events.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "Counters.h"
#include "Options.h"
#include "OracleGeometry.h"
#include "OracleMask.h"
#include "shared/values/Fixed.h"

namespace oracle {

/// The box of a single character: one cell, centred on the position.
inline constexpr FixedBox kCharacterBox{{-df::kFixedOne / 2, -df::kFixedOne / 2},
                                        {df::kFixedOne, df::kFixedOne}};

/// An Object of the book, without anything to draw.
struct Object : State {
  int id = 0;
  FixedVector acceleration;
  bool gone = false;  ///< deleted or removed from the world; only older lists still contain it
  Mask mask;          ///< beyond the book, as the options are (docs/collisions.md)

  Object() { box = kCharacterBox; }
  bool isSolid() const { return solidness == df::HARD || solidness == df::SOFT; }
  FixedVector predictPosition() const { return position + velocity; }
  /// Returns the box that the Object would have at `where` (section 4.13).
  FixedBox getWorldBox(FixedVector where) const { return {box.corner + where, box.size}; }
};

using ObjectList = std::vector<Object*>;

/// The eventHandler()s of a world's Objects.
class Handlers {
 public:
  virtual ~Handlers() = default;
  virtual void step(Object* p_receiver) = 0;
  /// `p_obj1` caused the collision with `p_obj2` by moving to `where` (a swept move may have aimed further).
  virtual void collision(Object* p_receiver, Object* p_obj1, Object* p_obj2, FixedVector where) = 0;
  virtual void out(Object* p_receiver) = 0;
  /// Stands for the Object's destructor.
  virtual void destroyed(Object* p_o) = 0;
};

/// The first hit of a move.
struct Contact {
  Object* p_object = nullptr;  ///< null: no hit
  Time time{1, 1};
  FixedVector position;  ///< mover's position just before the hit; the target if there is no hit
};

class World {
 public:
  /// Maximum depth of moveObject() calls, each made in a handler of the one before.
  static constexpr int kDeepestMove = 32;
  /// Maximum distance in cells, per axis, that findFree() searches.
  static constexpr int kFarthestFree = 1000;

  /// `handlers` must outlive the world.
  World(const FixedBox& boundary, Handlers& handlers) : m_boundary(boundary), m_handlers(handlers) {}

  /// Adds a new Object at the end of the list.
  Object* create(int id);
  /// Deletes the Object at the end of the next update; marking it twice has no further effect.
  void markForDelete(Object* p_o);
  /// Deletes the Object at once, as `delete p_o` does.
  void destroy(Object* p_o);
  /// Removes the Object without deleting it. Older lists and the mark for deletion no longer apply to it.
  void remove(Object* p_o);
  /// Puts a removed Object back, at the end of the list. Returns its new pointer.
  Object* insert(const Object* p_o);

  /// Sends the step event to all Objects that exist when it begins.
  void step();
  /// Makes all moves, then all deletions.
  void update();
  int moveObject(Object* p_o, FixedVector where);
  /// Returns the Objects that p_o touches at `where`: by their boxes and, if one of the two is precise, also
  /// by their masks.
  ObjectList getCollisions(const Object* p_o, FixedVector where);
  /// If true, all moves that begin from now on are swept.
  void setSweptCollisions(bool swept) { m_swept_collisions = swept; }
  bool getSweptCollisions() const { return m_swept_collisions; }
  Contact firstContact(const Object* p_o, FixedVector where);
  std::optional<FixedVector> findFree(const FixedBox& box, FixedVector near) const;

  /// Returns the Objects in creation order.
  const ObjectList& getAllObjects() const { return m_updates; }
  const Counters& counters() const { return m_counters; }

 private:
  /// An Object that a move hits.
  struct Hit {
    Object* p_other;
    Time time;
  };
  using HitList = std::vector<Hit>;
  enum class Verdict { PASSES, HARD_BLOCK, SOFT_BLOCK, MOVES_OUT };

  int moveNow(Object* p_o, FixedVector where);
  bool moveAtOnce(Object* p_o, const SweepPath& path);
  int moveSwept(Object* p_o, const SweepPath& path);
  HitList getHits(const Object* p_o, const SweepPath& path);
  std::optional<Time> hitTime(const Object* p_o, const SweepPath& path, const Object* p_other);
  bool isPrecise(const Object* p_o, const Object* p_other) const;
  bool shareCellAt(const Object* p_o, FixedVector where, const Object* p_other);
  void sendToBoth(Object* p_o, Object* p_other, FixedVector where);
  Verdict judge(const Object* p_o, const Object* p_other, const SweepPath& path) const;
  bool cutAtFirstBlock(HitList& hits, const Object* p_o, const SweepPath& path) const;
  void place(Object* p_o, FixedVector where);
  bool isInside(FixedVector position) const;
  bool isFree(const FixedBox& box) const;

  FixedBox m_boundary;
  Handlers& m_handlers;
  bool m_swept_collisions = false;
  ObjectList m_updates;
  ObjectList m_deletions;
  int m_depth = 0;
  Counters m_counters;
  std::vector<std::unique_ptr<Object>> m_memory;  ///< all Objects ever created, so that no pointer dangles
};

}  // namespace oracle
