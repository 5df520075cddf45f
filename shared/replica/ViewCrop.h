// Which part of a view a smaller terminal shows: one integer function, run by the client that draws and by
// the server that need not send the rest.
#pragma once

#include <algorithm>

namespace naiad {

/// The first of `shown` cells on an axis of `extent` (≥ shown): `focus`, counted like the result from the
/// view's edge, is in the middle as far as the edges allow.
inline int cropStart(int focus, int shown, int extent) {
  return std::clamp(focus - shown / 2, 0, extent - shown);
}

}  // namespace naiad
