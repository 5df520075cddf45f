// What a contact or an attachment does to a wide body: an implicit spring at one or two of its nodes.
#pragma once

#include "physics/soft/SoftContact.h"

namespace naiad::physics {

struct SoftPush {
  SoftRow* p_row = nullptr;
  const SoftPoint* p_own = nullptr;  ///< the side that the body itself is
  const SoftPoint* p_other = nullptr;
  double sign = 1;  ///< −1: it is the row's B
  Vec2 gone;        ///< the other side's movement in this sub-step, as far as it is known
  double gap = 0;   ///< along the normal, less what is too deep to be made good in this sub-step
  double stiffness = 0;
  /// Along each axis: its force on A at the offsets of the last assembly, and less of it per movement.
  double force[2] = {0, 0};
  double yield[2] = {0, 0};
};

}  // namespace naiad::physics
