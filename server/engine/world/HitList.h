// Lists the solid Objects that a move hits on its path, in the order of (time, creation).
//
// The grid is queried piece by piece in the order of travel, and no further than the end of the list. The
// levels of the grid take turns, so that none is searched far ahead of the others.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "engine/collision/ObjectKeySet.h"
#include "engine/collision/Sweep.h"
#include "engine/collision/SweepPath.h"
#include "engine/world/WorldStore.h"

namespace df {

struct Hit {
  Moment moment;
  std::uint64_t order;  ///< place in the world's creation order
  ObjectKey key;
};

class HitList {
 public:
  /// Kinds of ends: the first time at which a pair would block, or the first hit.
  enum End { kBlock, kFirst };

  /// Lists what `mover`, in the world and solid, hits on `path` at `since` or later, except Objects in `met`.
  void fill(const WorldStore& store, WorldStore::Slot mover, const SweepPath& path, End end,
            Moment since = {}, const ObjectKeySet* p_met = nullptr);

  const std::vector<Hit>& hits() const { return m_hits; }
  /// Returns when the list ends; nullopt if it goes to the end of the path.
  std::optional<Moment> end() const { return m_end; }

 private:
  class Search;

  std::vector<Hit> m_hits;
  std::optional<Moment> m_end;
};

}  // namespace df
