// Boxes sorted into square bins by their corners, a simple way to find those near an area.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "shared/values/Fixed.h"

namespace bench {

class Bins {
 public:
  /// Sorts boxes with corners in [0, side)² and sizes up to `largest`, in cells. Boxes outside go into the
  /// outermost bins.
  Bins(const std::vector<df::FixedBox>& boxes, double side, double bin, double largest)
      : m_bin(static_cast<df::Fixed>(bin * df::kFixedOne)),
        m_largest(static_cast<df::Fixed>(largest * df::kFixedOne)),
        m_row(static_cast<int>(side / bin) + 1),
        m_begins(static_cast<std::size_t>(m_row) * static_cast<std::size_t>(m_row) + 1) {
    for (const df::FixedBox& box : boxes) ++m_begins[binOf(box.corner) + 1];
    for (std::size_t i = 1; i < m_begins.size(); ++i) m_begins[i] += m_begins[i - 1];
    std::vector<std::uint32_t> ends(m_begins.begin(), m_begins.end() - 1);
    m_members.resize(boxes.size());
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      m_members[ends[binOf(boxes[i].corner)]++] = static_cast<std::uint32_t>(i);
    }
  }

  /// Calls `visit(index)` for all boxes that may touch `area`, and for some that do not.
  template <class Visit>
  void near(const df::FixedBox& area, Visit visit) const {
    const int last_x = indexOf(area.corner.x + area.size.x);
    const int last_y = indexOf(area.corner.y + area.size.y);
    for (int y = indexOf(area.corner.y - m_largest); y <= last_y; ++y) {
      const auto row = static_cast<std::size_t>(y) * static_cast<std::size_t>(m_row);
      const std::size_t first = row + static_cast<std::size_t>(indexOf(area.corner.x - m_largest));
      const std::size_t last = row + static_cast<std::size_t>(last_x);
      for (std::uint32_t i = m_begins[first]; i < m_begins[last + 1]; ++i) visit(m_members[i]);
    }
  }

 private:
  int indexOf(df::Fixed coordinate) const {
    return static_cast<int>(std::clamp<df::Fixed>(coordinate / m_bin, 0, m_row - 1));
  }
  std::size_t binOf(df::FixedVector corner) const {
    return static_cast<std::size_t>(indexOf(corner.y)) * static_cast<std::size_t>(m_row) +
           static_cast<std::size_t>(indexOf(corner.x));
  }

  df::Fixed m_bin;
  df::Fixed m_largest;
  int m_row;
  std::vector<std::uint32_t> m_begins;  // start of each bin in m_members, then the end of the last
  std::vector<std::uint32_t> m_members;
};

}  // namespace bench
