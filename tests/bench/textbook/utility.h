// Listing 4.107 of the Dragonfly book.
#pragma once

#include "Vector.h"

namespace textbook {

// Return true if two positions intersect, else false.
bool positionsIntersect(Vector p1, Vector p2);

}  // namespace textbook
