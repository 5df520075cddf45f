// Selects the part of a view that a smaller terminal shows. The client draws it; the server may omit objects
// outside it.
#pragma once

#include <algorithm>

namespace naiad {

/// Returns the first of `shown` cells on an axis of `extent` (≥ shown) cells, so that `focus` is in the
/// middle as far as the edges allow. The result and `focus` are relative to the view's edge.
inline int cropStart(int focus, int shown, int extent) {
  return std::clamp(focus - shown / 2, 0, extent - shown);
}

}  // namespace naiad
