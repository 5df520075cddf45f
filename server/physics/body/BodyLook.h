// What a Body looks like: the pictures of its turn, and which of them is shown.
//
// The picture shown follows a selector (naiad::Selector), an integer function of the tick: as long as the
// body turns as that says, to within a part of a picture, the selector stays, and nothing has to be
// published. So what is on the screen is always what the selector says, on the server too.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "physics/body/BodyForm.h"
#include "physics/body/BodyFrames.h"
#include "shared/replica/Look.h"
#include "shared/values/Fixed.h"

namespace naiad::physics {

class BodyLook {
 public:
  /// From now on draw it so.
  void restyle(FrameStyle style);

  /// Take in how the body is in this tick. `box`: the Object's, which is its shape where it has no other.
  void update(const BodyForm& form, const df::FixedBox& box, double aspect, std::uint32_t tick);
  const Sequence& frames() const { return m_turn.frames; }
  const Selector& selector() const { return m_selector; }
  /// Did the last update() make other pictures? Did it choose another selector?
  bool hasNewFrames() const { return m_new_frames; }
  bool hasNewSelector() const { return m_new_selector; }

 private:
  bool isUpToDate(const BodyForm& form, const df::FixedBox& box, double aspect) const;
  void redraw(const BodyForm& form, const df::FixedBox& box, double aspect);
  void choose(const BodyForm& form, std::uint32_t tick);

  FrameStyle m_style;
  TurnFrames m_turn;
  Selector m_selector;
  // What the pictures were made of.
  bool m_made = false;
  bool m_turns = false;  ///< they show a whole turn; else only `m_rotation`
  std::vector<ConvexShape> m_shapes;
  df::FixedBox m_box;
  double m_aspect = 0;
  Rotation m_rotation;
  bool m_new_frames = false;
  bool m_new_selector = false;
};

/// 2^32 are a turn; `angle` is finite, in radians.
std::uint32_t integerAngle(double angle);

}  // namespace naiad::physics
