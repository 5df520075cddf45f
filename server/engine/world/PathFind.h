// Finds a path through the world for Object::pathTo(): A* over whole cells and their eight neighbours, round
// active HARD Objects that the walker would touch there.
#pragma once

#include "EventPath.h"
#include "Object.h"
#include "Vector.h"

namespace df {

/// The shortest path from where the Object is to `end`, inside the world boundary; the target itself may be
/// taken, so that an Object can walk up to another. Of equally short ones always the same. The path is empty
/// if there is none, or if the search would visit more than 20,000 cells.
Path findPath(const Object& object, Vector end);

}  // namespace df
