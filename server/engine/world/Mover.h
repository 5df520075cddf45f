// How Objects move: the book's update() and moveObject() (Listings 4.101, 4.109, 4.111, 4.113), made whole.
//
// One move of a solid, active Object: the solid Objects touched at the target are listed once, in creation
// order, before the first event. For each that is still in the world, the collision event goes to the mover,
// then to the other. After both handlers have run, the pair is judged by what the two are then: it blocks
// if both are HARD, or if the mover is no-soft and the other SOFT. All pairs get their events, even when
// an earlier one blocks; then a blocked mover stays where it is (or where a handler put it), and another
// is set to the target (wherever a handler put it). At last, if that set took it from inside the
// boundary to outside, it gets an out event: its position, or, if the world is compatible with the published
// engine, its box, which then has no point in common with the boundary any more.
//
// What handlers may do meanwhile:
//  - delete or remove the other: the other gets no more events, the pair blocks nothing;
//  - delete or remove the mover: the move ends at once, -1, and the rest of the list gets no events;
//  - make either inactive: it gets no events from then on, the move goes on;
//  - make either SPECTRAL: it still gets the events of the listed pairs, which then do not block;
//  - mark for deletion, move, create, resize: the list stays as it is, the move goes on.
//
// That is the book's move. Beyond it there are moves that are tested along the path (SweptMove) and pairs
// whose characters are tested, or that do not block (CollisionRule.h).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/collision/KeySet.h"
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
/// It goes in stages. Each lists what the mover hits, up to the first time at which a pair would block as
/// things stand, sends the event to both of each pair and judges the pair afterwards. If it does not block
/// after all (a handler has deleted the glass), the next stage searches the rest of the path, in the world as
/// it is then.
/// Its memory is kept for the next move.
class SweptMove {
 public:
  /// A handler may make a new obstacle for each that it deletes: a move with so many stages is blocked.
  static constexpr int kMaxStages = 1000;

  /// Where a move ended: at its target, just before a contact, or where the mover is already, because a
  /// handler put it there or it cannot move.
  enum class End { kTarget, kContact, kNone };
  /// Sends the events of what `mover`, in the world and solid, hits on its path to `where`. If a pair blocks
  /// it and no handler has moved it, sets `where` to its place just before the contact. The caller places
  /// the mover.
  End run(EventDispatch& events, WorldStore& store, ObjectKey mover, FixedVector& where);

 private:
  enum class Outcome { kFree, kBlocked, kGone };
  struct Verdict {
    Outcome outcome;
    Moment moment;  // of the block
  };

  Verdict sendHits(EventDispatch& events, const WorldStore& store, ObjectKey mover, const SweepPath& path);

  HitList m_list;
  KeySet m_met;  // in the stages before this one
};

class Mover {
 public:
  /// Moves inside handlers of moves inside handlers … deeper than this are refused.
  static constexpr int kMaxDepth = 32;

  /// All live longer than this.
  Mover(ObjectRegistry& objects, Views& views, EventDispatch& events, const WorldState& state);
  WorldStore& store() const { return m_store; }
  Views& views() const { return m_views; }

  /// Every active Object that was in the world when this began, in creation order: move it by its velocity,
  /// then add its acceleration to the velocity. Activity is read at the Object's turn.
  void moveAll();
  /// WM.moveObject().
  int moveObject(Object* p_o, Vector where);
  /// Move one Object. Return 0 if it moved, else -1.
  int move(ObjectKey mover, FixedVector where);

  // Parts of a move.

  /// Put the mover there, with the views that follow it, and send it an out event if it leaves the world.
  void place(ObjectKey mover, FixedVector where);

 private:
  int walkOn(std::size_t word, std::uint64_t turns);
  int flyOn(std::uint32_t first, std::uint64_t fliers, std::uint64_t sequels, int bit);
  void finishWalk(ObjectKey key, std::vector<ObjectKey>& others);
  void takeTurn(ObjectKey key);
  void endTurn(ObjectKey key, FixedVector velocity, bool blocked);
  bool collideAt(ObjectKey mover, FixedVector where, std::vector<ObjectKey>& others);
  bool collide(ObjectKey mover, FixedVector where, const std::vector<ObjectKey>& others);
  bool isInWorld(std::uint32_t slot, FixedVector where) const;
  FixedBox roomToFly() const;

  WorldStore& m_store;
  ObjectRegistry& m_objects;
  Views& m_views;
  EventDispatch& m_events;
  const WorldState& m_state;
  int m_depth = 0;
  std::array<std::vector<ObjectKey>, kMaxDepth> m_lists;  // one per depth, kept for their memory
  std::array<SweptMove, kMaxDepth> m_swept;               // likewise
};

}  // namespace df
