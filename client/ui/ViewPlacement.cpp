#include "client/ui/ViewPlacement.h"

#include <algorithm>

#include "shared/replica/ViewCrop.h"

namespace naiad {
namespace {

/// Places the view on one axis. `room`, `extent`: number of cells of the terminal and of the view. `focus`:
/// view cell that stays visible.
void placeAxis(int room, int extent, int focus, int& start, int& view_start, int& shown) {
  shown = std::min(room, extent);
  start = (room - shown) / 2;
  view_start = cropStart(focus, shown, extent);
}

}  // namespace

std::optional<CellPosition> ViewPlacement::toView(int column, int row) const {
  const int x = column - left;
  const int y = row - top;
  if (x < 0 || y < 0 || x >= width || y >= height) return std::nullopt;
  return CellPosition{view_x + x, view_y + y};
}

ViewPlacement placeView(int columns, int rows, int view_width, int view_height, CellPosition focus,
                        bool want_status) {
  ViewPlacement place;
  place.status_row = want_status && rows > view_height;
  place.status_side = want_status && !place.status_row && columns >= view_width + kSideColumns;
  const int room = rows - (place.status_row ? 1 : 0);
  placeAxis(columns - (place.status_side ? kSideColumns : 0), view_width, focus.x, place.left, place.view_x,
            place.width);
  placeAxis(room, view_height, focus.y, place.top, place.view_y, place.height);
  place.framed = columns >= view_width + 2 && room >= view_height + 2;
  return place;
}

}  // namespace naiad
