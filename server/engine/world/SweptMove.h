// One move that is tested all along its way (docs/collisions.md, "Swept").
//
// It goes in stages. Each lists whom the mover hits, up to the first time at which a pair would block as
// things stand, tells both sides of each pair and judges it afterwards. If that block came to nothing - a
// handler broke the glass - the next stage searches the rest of the way, in the world as it is then.
#pragma once

#include "engine/collision/KeySet.h"
#include "engine/world/HitList.h"
#include "engine/world/WorldView.h"
#include "shared/values/Fixed.h"

namespace df {

class Mover;
class World;

/// Its memory is kept for the next move.
class SweptMove {
 public:
  /// A handler may put up a new glass for each that breaks: a move that has broken so many is blocked.
  static constexpr int kMaxStages = 1000;

  /// Meet whom `mover`, in the world and solid, hits on its way to `where`. If that blocks it, place it just
  /// before, if it still stands where it was. Return whether it may move on to `where`.
  bool run(Mover& moves, World& world, ObjectKey mover, FixedVector where);

 private:
  enum class Outcome { kFree, kBlocked, kGone };
  struct Verdict {
    Outcome outcome;
    Moment moment;  // of the block
  };

  Verdict meetAll(World& world, ObjectKey mover, const SweepPath& way);

  HitList m_list;
  KeySet m_met;  // in the stages before this one
};

}  // namespace df
