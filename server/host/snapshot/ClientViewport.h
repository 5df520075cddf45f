// The cells of the world that one client can show: its view, or if its terminal is smaller, the part around
// the object that the view follows, or around the middle of the view if it follows none.
//
// A terminal larger than the view does not show more of the world.
#pragma once

#include <cstdint>

#include "host/snapshot/Publisher.h"

namespace naiad {

class ClientViewport {
 public:
  /// Sets the client's terminal size, in cells, clamped to usable sizes; 0: unknown, the largest is assumed.
  void setTerminal(std::uint32_t columns, std::uint32_t rows);

  /// True if the terminal shows all of a view of this size.
  bool covers(int view_width, int view_height) const {
    return m_x.cells >= view_width && m_y.cells >= view_height;
  }
  /// Returns the cells that the client shows at the publisher's tick or may show within `look_ahead` ticks,
  /// plus a margin for clients that predict collisions. Call once a tick.
  CellRect update(const Publisher& publisher, const df::PlayerFacts& player, std::uint32_t look_ahead);

  static constexpr int kMinColumns = 20;
  static constexpr int kMinRows = 10;

 private:
  /// The part of the view that is shown, on one axis.
  struct Axis {
    int cells = 0;           ///< size of the terminal
    std::int64_t spare = 0;  ///< extra cells on either side, because the client may see the player elsewhere
    void updateSpare(double cells_per_tick, std::uint32_t tick);
    /// Extends low … high by the part of a view that is shown.
    void cover(std::int64_t corner, int extent, std::int64_t focus, std::int64_t& low,
               std::int64_t& high) const;
  };
  Axis m_x{kMaxViewWidth};
  Axis m_y{kMaxViewHeight};
};

}  // namespace naiad
