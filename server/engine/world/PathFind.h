// Finds a path through the world for Object::pathTo(): A* over whole cells and their eight neighbours, round
// active HARD Objects that the walker would touch.
#pragma once

#include "EventPath.h"
#include "Object.h"
#include "Vector.h"

namespace df {

/// Returns the shortest path from the Object's position to `end`, inside the world boundary. The target
/// itself may be outside the boundary, or occupied, so that an Object can walk up to another. The choice
/// among equally short paths is always the same. The path is empty if none exists, if the search would visit
/// more than 20,000 cells, if `end` is 10,000 cells or more away on an axis, or if the Object has no world.
Path findPath(const Object& object, Vector end);

}  // namespace df
