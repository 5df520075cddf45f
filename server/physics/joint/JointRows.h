// A joint as scalar constraints on two rotating bodies at their present positions.
#pragma once

#include <array>

#include "physics/joint/Joint.h"

namespace naiad::physics {

/// The speed of a row is dot(n, velocity of b − velocity of a) + ja · spin of a + jb · spin of b.
struct SpeedRow {
  Vec2 n;                 ///< force direction: +n on b, −n on a; (0,0): only a torque
  double ja = 0, jb = 0;  ///< factors of the spins, with sign
  double value = 0;       ///< position error
  int side = 0;           ///< ±1: only impulses of this sign, which act when the value would pass 0
};

/// The anchors of a joint, in world axes.
struct JointFrame {
  Vec2 arm_a, arm_b;  ///< positions relative to the bodies' centres
  Vec2 offset;        ///< displacement from a's anchor, or the target, to b's anchor
  Vec2 axis;
  Rotation between;  ///< rotation of b relative to a, measured from the reference
};

using SpeedRows = std::array<SpeedRow, 3>;

/// Writes the first rowsOf(joint) entries of `rows`.
void placeRows(const Joint& joint, const JointFrame& frame, SpeedRows& rows);

/// True if the row holds an angle, false if it holds points.
bool isAngleRow(JointKind kind, int row);

}  // namespace naiad::physics
