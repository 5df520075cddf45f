// Places the game's view in the terminal: centred if it fits, otherwise cropped around the player.
#pragma once

#include <optional>

#include "shared/replica/Look.h"

namespace naiad {

/// Minimum size of the terminal; in a smaller one the client only says that it is too small.
inline constexpr int kMinColumns = 20;
inline constexpr int kMinRows = 10;

/// Width of the status at the right of the view, if there is no row for it.
inline constexpr int kSideColumns = 11;

/// Terminal cell (left + i, top + j) shows view cell (view_x + i, view_y + j), for i < width, j < height.
struct ViewPlacement {
  int left = 0;
  int top = 0;
  int view_x = 0;
  int view_y = 0;
  int width = 0;
  int height = 0;
  bool framed = false;       ///< a frame of one cell surrounds the view
  bool status_row = false;   ///< the last row of the terminal is reserved for the status
  bool status_side = false;  ///< the last kSideColumns columns are reserved for the status

  /// Returns the view cell shown at a terminal cell; nullopt outside the view.
  std::optional<CellPosition> toView(int column, int row) const;
};

/// Places a view in a terminal of `columns` by `rows` cells. `focus`, in view cells, stays in the middle of a
/// cropped view as far as the view's edges allow. `want_status`: the status line is on.
ViewPlacement placeView(int columns, int rows, int view_width, int view_height, CellPosition focus,
                        bool want_status);

}  // namespace naiad
