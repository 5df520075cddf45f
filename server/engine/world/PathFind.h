// Finds a way through the world for Object::pathTo(): A* over whole cells and their eight neighbours, round
// active HARD Objects that the walker would touch there.
#pragma once

#include "EventPath.h"
#include "Object.h"
#include "Vector.h"

namespace df {

/// The shortest way from where the Object is to `end`, inside the world boundary; the target itself may be
/// taken, so that one can walk up to somebody. Of equally short ones always the same. The path is empty if
/// there is none, or if it takes a look at more than 20,000 cells to know.
Path findPath(const Object& object, Vector end);

}  // namespace df
