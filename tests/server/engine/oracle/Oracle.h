// The book's world, written as plainly as the book prints it, and docs/collisions.md as plainly as it is
// written there: the loop over all Objects against which the engine is compared, bit for bit. Nothing of the
// engine is used here but its number type.
//
// Listing 4.100 predictPosition, 4.101 update, 4.104 isSolid, 4.107 positionsIntersect (with boxes, section
// 4.13), 4.108 getCollisions, 4.109 moveObject, 4.111 no soft, 4.113 out of bounds; and two things that the
// listings leave open: an Object that a handler deletes is passed over wherever a list still names it, and an
// inactive one gets no events.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "Counters.h"
#include "OracleGeometry.h"
#include "OracleMask.h"
#include "shared/values/Fixed.h"
#include "shared/values/Solidness.h"

namespace oracle {

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

  // Beyond the book (docs/collisions.md).
  bool swept = false;
  bool precise = false;
  Mask mask;
  bool rest_contacts = false;
  bool may_move_out = false;

  bool isSolid() const { return solidness == df::HARD || solidness == df::SOFT; }
  FixedVector predictPosition() const { return position + velocity; }
  /// The box if the Object were at `where` (section 4.13).
  FixedBox getWorldBox(FixedVector where) const { return {box.corner + where, box.size}; }
};

using ObjectList = std::vector<Object*>;

/// What the Objects of a world do about events: their eventHandler()s.
class Handlers {
 public:
  virtual ~Handlers() = default;
  virtual void step(Object* p_receiver) = 0;
  /// `p_obj1` caused the collision by moving to `where` (or, if swept, further), onto `p_obj2`.
  virtual void collision(Object* p_receiver, Object* p_obj1, Object* p_obj2, FixedVector where) = 0;
  virtual void out(Object* p_receiver) = 0;
  /// The Object is going: its destructor.
  virtual void destroyed(Object* p_o) = 0;
};

/// What a move would hit first.
struct Contact {
  Object* p_object = nullptr;  ///< null: none
  Time time{1, 1};
  FixedVector position;  ///< of the mover just before; the target if it hits nothing
};

class World {
 public:
  /// At most this many moveObject()s at once, one within a handler of the other.
  static constexpr int kDeepestMove = 32;
  /// findFree() looks at most this many cells far on each axis.
  static constexpr int kFarthestFree = 1000;

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
  /// What p_o touches if it is at `where`; if one of the two is precise, by their masks, too.
  ObjectList getCollisions(const Object* p_o, FixedVector where);
  /// All moves that begin from now on are swept.
  void setSweptCollisions(bool swept) { m_swept_collisions = swept; }
  bool getSweptCollisions() const { return m_swept_collisions; }
  Contact firstContact(const Object* p_o, FixedVector where);
  std::optional<FixedVector> findFree(const FixedBox& box, FixedVector near) const;

  /// In creation order.
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
  std::vector<std::unique_ptr<Object>> m_memory;  ///< every Object that ever was, so that no pointer dangles
};

}  // namespace oracle
