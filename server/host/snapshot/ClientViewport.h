// The cells of the world that one client can show: its view, or where its terminal is smaller, the part
// around the object that the view follows.
//
// A terminal that is larger than the view shows no more of the world than other terminals do.
#pragma once

#include <cstdint>

#include "host/snapshot/Publisher.h"

namespace naiad {

class ClientViewport {
 public:
  /// The client's terminal, in cells; 0: unknown, taken to be the largest. Clamped to what a client can use.
  void setTerminal(std::uint32_t columns, std::uint32_t rows);

  /// Does it show all of a view of this size?
  bool covers(int view_width, int view_height) const {
    return m_x.cells >= view_width && m_y.cells >= view_height;
  }
  /// What the client shows at the publisher's tick or may show within `look_ahead` ticks, and a margin for
  /// clients that predict collisions. Once a tick.
  CellRect update(const Publisher& publisher, const df::PlayerFacts& player, std::uint32_t look_ahead);

  static constexpr int kMinColumns = 20;
  static constexpr int kMinRows = 10;

 private:
  /// One axis: what of the view is shown.
  struct Axis {
    int cells = 0;           ///< of the terminal
    std::int64_t spare = 0;  ///< to either side, since the client may see the player elsewhere
    void noteSpeed(double cells_per_tick, std::uint32_t tick);
    /// Widen low … high by what is shown of a view.
    void cover(std::int64_t corner, int extent, std::int64_t focus, std::int64_t& low,
               std::int64_t& high) const;
  };
  Axis m_x{kMaxViewWidth};
  Axis m_y{kMaxViewHeight};
};

}  // namespace naiad
