// Lists the solid Objects that a move hits on its path, in the order of (time, creation).
//
// The path is searched piece by piece in the order of travel, and only until the list is complete. The levels
// of the grid are searched in turn, so that no level is searched far ahead of the others.
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
  std::uint64_t order;  ///< the Object's place in the creation order
  ObjectKey key;
};

class HitList {
 public:
  /// Where the list ends: at the first time at which a pair would block, or at the first hit.
  enum End { kBlock, kFirst };

  /// Lists the Objects that `mover`, in the world and solid, hits on `path` at time `since` or later, except
  /// those in `p_met`.
  void fill(const WorldStore& store, WorldStore::Slot mover, const SweepPath& path, End end,
            Moment since = {}, const ObjectKeySet* p_met = nullptr);

  const std::vector<Hit>& hits() const { return m_hits; }
  /// Returns the time at which the list ends; nullopt if it covers the whole path.
  std::optional<Moment> end() const { return m_end; }

 private:
  class Search;

  std::vector<Hit> m_hits;
  std::optional<Moment> m_end;
};

}  // namespace df
