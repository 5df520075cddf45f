// The first Object that a move would hit, and where: the result of WM.firstContact().
#pragma once

#include "Vector.h"

namespace df {

class Object;

struct Contact {
  Object* p_object = nullptr;  ///< null if nothing is hit
  double time = 1;             ///< 0 at the start of the move, 1 at its end
  Vector position;             ///< mover's position just before the contact, or its target if none
};

}  // namespace df
