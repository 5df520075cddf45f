// The objects whose published positions are exact to the bit, as a client's view or prediction needs them.
#pragma once

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

#include "engine/world/WorldView.h"

namespace naiad {

class ExactObjects {
 public:
  /// Take in one tick: the objects that players follow or steer. Returns whether any player steers by
  /// declared controls.
  bool updatePlayers(std::span<const df::PlayerFacts> players) {
    m_keys.clear();
    bool controls = false;
    for (const df::PlayerFacts& player : players) {
      if (player.followed.generation != 0) m_keys.push_back(player.followed);
      if (player.steering.object.generation != 0) m_keys.push_back(player.steering.object);
      controls = controls || player.steering.p_table != nullptr;
    }
    std::sort(m_keys.begin(), m_keys.end(), isBefore);
    return controls;
  }
  const std::vector<df::ObjectKey>& keys() const { return m_keys; }
  bool contains(df::ObjectKey key) const {
    auto found = std::lower_bound(m_keys.begin(), m_keys.end(), key, isBefore);
    for (; found != m_keys.end() && found->slot == key.slot; ++found) {
      if (found->generation == key.generation) return true;
    }
    return false;
  }

  /// Solid objects that stand still are exact, too.
  void setSolids(bool exact) {
    m_solids_are_new = m_solids_are_new || (exact && !m_solids);
    m_solids = exact;
  }
  bool hasSolids() const { return m_solids; }
  /// True once after setSolids(): those published before are still coarse.
  bool takeNewSolids() { return std::exchange(m_solids_are_new, false); }

 private:
  static bool isBefore(df::ObjectKey a, df::ObjectKey b) { return a.slot < b.slot; }

  std::vector<df::ObjectKey> m_keys;  ///< by slot
  bool m_solids = false;
  bool m_solids_are_new = false;
};

}  // namespace naiad
