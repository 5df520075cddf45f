// A joint as scalar constraints on two bodies that turn, where they are now.
#pragma once

#include <array>

#include "physics/joint/Joint.h"

namespace naiad::physics {

/// Its speed is dot(n, velocity of b − velocity of a) + ja · spin of a + jb · spin of b.
struct SpeedRow {
  Vec2 n;                 ///< b feels +n, a −n; (0,0): it turns only
  double ja = 0, jb = 0;  ///< on the spins, signs included
  double value = 0;       ///< how far it is off
  int side = 0;           ///< ±1: only impulses of this sign, when the value would pass 0
};

/// Two anchors, in the axes of the world.
struct JointFrame {
  Vec2 arm_a, arm_b;  ///< from the bodies' centres
  Vec2 offset;        ///< from a's anchor, or the target, to b's
  Vec2 axis;
  Rotation between;  ///< of b against a and the reference
};

using SpeedRows = std::array<SpeedRow, 3>;

/// The first rowsOf(joint) of them are written.
void placeRows(const Joint& joint, const JointFrame& frame, SpeedRows& rows);

/// Does the row hold an angle, rather than points?
bool isAngleRow(JointKind kind, int row);

}  // namespace naiad::physics
