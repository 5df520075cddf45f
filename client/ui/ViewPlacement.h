// Where the game's view lies in the terminal: centred if there is room, else cropped around the player.
#pragma once

#include <optional>

#include "shared/replica/Look.h"

namespace naiad {

/// Below this the client only says that the terminal is too small.
inline constexpr int kMinColumns = 20;
inline constexpr int kMinRows = 10;

/// Columns beside the view that the status takes if there is no row for it.
inline constexpr int kSideColumns = 11;

/// Terminal cell (left + i, top + j) shows view cell (view_x + i, view_y + j), for i < width, j < height.
struct ViewPlacement {
  int left = 0;
  int top = 0;
  int view_x = 0;
  int view_y = 0;
  int width = 0;
  int height = 0;
  bool framed = false;       ///< a frame of one cell around the view
  bool status_row = false;   ///< the last row of the terminal is the status line's alone
  bool status_side = false;  ///< its last kSideColumns columns are, since there is no row

  /// The view cell shown at a terminal cell; nothing beside the view.
  std::optional<CellPosition> toView(int column, int row) const;
};

/// Place a view of the given size in a terminal of `columns` by `rows` cells. `focus`, in view cells, stays
/// in the middle of a cropped view as far as the view's edges allow. `want_status`: the status line is on.
ViewPlacement placeView(int columns, int rows, int view_width, int view_height, CellPosition focus,
                        bool want_status);

}  // namespace naiad
