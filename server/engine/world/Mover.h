// Moves Objects, as in the book's update() and moveObject() (Listings 4.101, 4.109, 4.111, 4.113).
//
// One move of a solid, active Object: the solid Objects touched at the target are listed once, in creation
// order, before the first event. For each that is still in the world, the collision event is sent to the
// mover, then to the other. After both handlers have run, the state that the two then have decides: the pair
// blocks if both are HARD, or if the mover is no-soft and the other SOFT. All pairs get their events, even if
// an earlier pair blocks. Then a blocked mover stays where it is (or where a handler put it); a mover that is
// not blocked is set to the target (wherever a handler put it). Last, if this took the mover from inside the
// boundary to outside, it gets an out event. Inside means that its position lies in the boundary or, in a
// world with compat, that its box shares a point with the boundary.
//
// During the move, handlers may:
//  - delete or remove the other Object: it gets no more events, and the pair does not block;
//  - delete or remove the mover: the move ends at once with -1, and the remaining pairs get no events;
//  - make either inactive: it gets no more events, but the move continues;
//  - make either SPECTRAL: it still gets the events of the listed pairs, which then do not block;
//  - mark, move, create or resize Objects: the list does not change, and the move continues.
//
// In addition to the book's moves, there are moves that are tested along their path (SweptMove), pairs whose
// characters are compared, and pairs that do not block (CollisionRule.h).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/collision/ObjectKeySet.h"
#include "engine/world/HitList.h"
#include "shared/values/Fixed.h"
#include "shared/values/Vector.h"

namespace df {

class EventCollision;
class EventDispatch;
class Object;
class ObjectRegistry;
class Views;
class WorldStore;
struct WorldState;

/// One move that is tested along its whole path (docs/collisions.md, "Swept").
///
/// The move is tested in stages. A stage lists the Objects that the mover hits, up to the first time at which
/// a pair would block in the present state. It sends the event to both Objects of each pair, and then decides
/// whether the pair blocks. If no pair blocks after all (a handler has deleted the glass), the next stage
/// searches the rest of the path, in the world as it is then. Memory is reused by the next move.
class SweptMove {
 public:
  /// Number of stages before a move is blocked, because handlers may replace each obstacle they delete.
  static constexpr int kMaxStages = 1000;

  /// Where a move ends: at its target, just before a contact, or where the mover is already (kNone), because
  /// a handler put it there or removed it, or it cannot move.
  enum class End { kTarget, kContact, kNone };
  /// Sends the events of all Objects that `mover`, in the world and solid, hits on its path to `where`. If a
  /// pair blocks and no handler has moved the mover, sets `where` to the mover's position just before the
  /// contact. The caller places the mover.
  End run(EventDispatch& events, WorldStore& store, ObjectKey mover, FixedVector& where);

 private:
  enum class Outcome { kFree, kBlocked, kGone };
  struct Verdict {
    Outcome outcome;
    Moment moment;  // moment at which the pair blocks
  };

  Verdict sendHits(EventDispatch& events, const WorldStore& store, ObjectKey mover, const SweepPath& path);

  HitList m_list;
  ObjectKeySet m_met;  // Objects hit in earlier stages
};

class Mover {
 public:
  /// Maximum depth of moves inside handlers of moves; deeper moves are refused.
  static constexpr int kMaxDepth = 32;

  /// The arguments must outlive this object.
  Mover(ObjectRegistry& objects, Views& views, EventDispatch& events, const WorldState& state);
  WorldStore& store() const { return m_store; }
  Views& views() const { return m_views; }

  /// Moves every active Object that was in the world when the call began, in creation order: by its velocity,
  /// then adds its acceleration to the velocity. Objects made inactive before their turn are not moved.
  void moveAll();
  /// See WM.moveObject().
  int moveObject(Object* p_o, Vector where);
  /// Moves one Object. Returns 0 if it reaches `where`, else -1.
  int move(ObjectKey mover, FixedVector where);

  // Parts of a move.

  /// Sets the mover's position, moves views that follow it, and sends an out event if it leaves the world.
  void place(ObjectKey mover, FixedVector where);

 private:
  int moveWalkers(std::size_t word, std::uint64_t turns);
  int moveFliers(std::uint32_t first, std::uint64_t fliers, std::uint64_t consecutive, int bit);
  void finishWalk(ObjectKey key, std::vector<ObjectKey>& others);
  void updateObject(ObjectKey key);
  void finishUpdate(ObjectKey key, FixedVector velocity, bool blocked);
  bool collideAt(ObjectKey mover, FixedVector where, std::vector<ObjectKey>& others);
  bool collide(ObjectKey mover, FixedVector where, const std::vector<ObjectKey>& others);
  bool isInWorld(std::uint32_t slot, FixedVector where) const;
  FixedBox flightBounds() const;

  WorldStore& m_store;
  ObjectRegistry& m_objects;
  Views& m_views;
  EventDispatch& m_events;
  const WorldState& m_state;
  int m_depth = 0;
  std::array<std::vector<ObjectKey>, kMaxDepth> m_lists;  // one per depth, reused
  std::array<SweptMove, kMaxDepth> m_swept;               // one per depth, reused
};

}  // namespace df
