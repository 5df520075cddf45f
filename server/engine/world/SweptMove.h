// One move that is tested along its whole path (docs/collisions.md, "Swept").
//
// It goes in stages. Each lists what the mover hits, up to the first time at which a pair would block as
// things stand, sends the event to both of each pair and judges the pair afterwards. If it does not block
// after all (a handler has deleted the glass), the next stage searches the rest of the path, in the world as
// it is then.
#pragma once

#include "engine/collision/KeySet.h"
#include "engine/world/HitList.h"
#include "shared/values/Fixed.h"

namespace df {

class EventDispatch;

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

}  // namespace df
