// Where a view lies that follows an object: one integer function, run by server and client alike.
#pragma once

#include "shared/replica/Motion.h"
#include "shared/values/Fixed.h"

namespace naiad {

/// A view and the world it looks into. All in fixed point, world coordinates.
struct ViewFrame {
  df::FixedVector corner;  ///< upper left corner of the view now
  df::FixedVector size;    ///< size of the view, whole cells
  df::FixedBox boundary;   ///< of the world
};

/// The corner after the followed object moved to `target`. The view moves by just as much as brings the
/// object back into its inner third (slack 1/3 on every side), then is clamped inside the boundary; on an
/// axis where the boundary is smaller than the view, it starts at the boundary's corner.
df::FixedVector followView(const ViewFrame& frame, df::FixedVector target);

/// The corner clamped inside the boundary, as above.
df::FixedVector clampView(const ViewFrame& frame, df::FixedVector corner);

/// The published model of a following view: its corner at `tick`, if it was `frame.corner` at `known` and
/// the followed object moves by `motion` (null: nothing is followed, the view stays). It depends on the two
/// newest records alone, not on when they arrived, so a client that lost some draws the same view; where
/// the true view differs (a path that turned in between), the server sends a new record.
df::FixedVector viewCornerAt(const ViewFrame& frame, std::uint32_t known, const Motion* motion,
                             std::uint32_t tick);

}  // namespace naiad
