// The drawing of a Body: the frames of its turn, and the choice of the frame shown.
//
// The frame shown is chosen by a selector (naiad::Selector), an integer function of the tick. While the
// selector differs from the body's angle by less than a part of a frame, it is kept and nothing is published.
// So the screen always shows the frame of the selector, on the server too.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "physics/body/BodyFrames.h"
#include "physics/body/BodyGeometry.h"
#include "shared/replica/Look.h"
#include "shared/values/Fixed.h"

namespace naiad::physics {

class BodyLook {
 public:
  /// Uses this style for all further drawings.
  void restyle(FrameStyle style);

  /// Updates frames and selector from the body's state in this tick. `box` is the Object's box, used as the
  /// shape if `form` has no shapes.
  void update(const BodyGeometry& form, const df::FixedBox& box, double aspect, std::uint32_t tick);
  const Sequence& frames() const { return m_turn.frames; }
  const Selector& selector() const { return m_selector; }
  /// True if the last update() made new frames, or (hasNewSelector) chose a new selector.
  bool hasNewFrames() const { return m_new_frames; }
  bool hasNewSelector() const { return m_new_selector; }

 private:
  bool isUpToDate(const BodyGeometry& form, const df::FixedBox& box, double aspect) const;
  void redraw(const BodyGeometry& form, const df::FixedBox& box, double aspect);
  void choose(const BodyGeometry& form, std::uint32_t tick);

  FrameStyle m_style;
  TurnFrames m_turn;
  Selector m_selector;
  // The input of drawTurn() for the present frames.
  bool m_made = false;
  bool m_turns = false;  ///< the frames show a whole turn; else only `m_rotation`
  std::vector<ConvexShape> m_shapes;
  df::FixedBox m_box;
  double m_aspect = 0;
  Rotation m_rotation;
  bool m_new_frames = false;
  bool m_new_selector = false;
};

/// Converts a finite angle in radians to units of 2^-32 turn.
std::uint32_t integerAngle(double angle);

}  // namespace naiad::physics
