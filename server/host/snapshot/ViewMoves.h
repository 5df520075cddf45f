// Finds out whether all views move slowly enough to predict what enters them.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <utility>
#include <vector>

#include "engine/world/WorldView.h"

namespace naiad {

class ViewMoves {
 public:
  /// Take in one tick. Returns whether a view has appeared or moved by more than a cell, or was resized.
  bool updateViews(const df::WorldView& view) {
    bool jumped = view.players.size() != m_corners.size();
    m_corners.resize(view.players.size());
    for (std::size_t i = 0; i < m_corners.size(); ++i) {
      const df::FixedVector corner = view.players[i].view_corner;
      const df::FixedVector moved{corner.x - m_corners[i].x, corner.y - m_corners[i].y};
      jumped = jumped || std::max(std::abs(moved.x), std::abs(moved.y)) > df::kFixedOne;
      m_corners[i] = corner;
    }
    const bool resized = std::exchange(m_width, view.view_width) != view.view_width ||
                         std::exchange(m_height, view.view_height) != view.view_height;
    return jumped || resized;
  }

 private:
  std::vector<df::FixedVector> m_corners;  ///< a tick ago
  std::int32_t m_width = 0;
  std::int32_t m_height = 0;
};

}  // namespace naiad
