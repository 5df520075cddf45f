// Places a view that follows an object: one integer function, run by server and client.
#pragma once

#include "shared/replica/Motion.h"
#include "shared/values/Fixed.h"

namespace naiad {

/// A view and the boundary of its world, in fixed-point world coordinates.
struct ViewFrame {
  df::FixedVector corner;  ///< upper left corner of the view now
  df::FixedVector size;    ///< size of the view, whole cells
  df::FixedBox boundary;   ///< boundary of the world
};

/// Returns the corner after the followed object moved to `target`. The view moves only as far as needed to
/// bring the object back into its inner third (slack 1/3 on every side), then it is clamped to the boundary.
/// On an axis where the boundary is smaller than the view, the view starts at the boundary's corner.
df::FixedVector followView(const ViewFrame& frame, df::FixedVector target);

/// Clamps the corner to the boundary, like followView().
df::FixedVector clampView(const ViewFrame& frame, df::FixedVector corner);

/// Returns the corner at `tick` of a view that follows an object, if it was `frame.corner` at `known` and the
/// object moves by `motion` (null: no object, the view stays). It depends only on the two newest records, so
/// a client that lost some draws an equal view. If the true view differs, because the object's path turned in
/// between, the server sends a new record.
df::FixedVector viewCornerAt(const ViewFrame& frame, std::uint32_t known, const Motion* motion,
                             std::uint32_t tick);

}  // namespace naiad
