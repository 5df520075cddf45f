// Boxes sorted by their left sides, a simple way to find those near an area.
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "shared/values/Fixed.h"

namespace bench {

class SortedBoxes {
 public:
  /// `widest` is the largest width of the boxes, in cells.
  SortedBoxes(const std::vector<df::FixedBox>& boxes, int widest) : m_widest(widest * df::kFixedOne) {
    for (const df::FixedBox& box : boxes) m_sorted.emplace_back(box, m_sorted.size());
    std::sort(m_sorted.begin(), m_sorted.end(), [](const Entry& a, const Entry& b) {
      return std::pair(a.first.corner.x, a.second) < std::pair(b.first.corner.x, b.second);
    });
  }

  /// Calls `visit(index)` for all boxes that may touch `area`.
  template <class Visit>
  void near(const df::FixedBox& area, Visit visit) const {
    auto entry = std::partition_point(m_sorted.begin(), m_sorted.end(), [&](const Entry& one) {
      return one.first.corner.x < area.corner.x - m_widest;
    });
    for (; entry != m_sorted.end() && entry->first.corner.x <= area.corner.x + area.size.x; ++entry) {
      const df::FixedBox& box = entry->first;
      if (box.corner.y > area.corner.y + area.size.y || box.corner.y + box.size.y < area.corner.y) continue;
      visit(entry->second);
    }
  }

 private:
  using Entry = std::pair<df::FixedBox, std::uint32_t>;
  df::Fixed m_widest;
  std::vector<Entry> m_sorted;
};

}  // namespace bench
