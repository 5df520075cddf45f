// The first Object that a move would hit, and where: the result of WM.firstContact().
#pragma once

#include "Vector.h"

namespace df {

class Object;

struct Contact {
  Object* p_object = nullptr;  ///< null: none
  double time = 1;             ///< 0 at the start of the move, 1 at its end
  Vector position;             ///< of the mover just before the contact; the target if there is none
};

}  // namespace df
