// Small functions about positions and boxes (book, Listings 4.107, 4.124, 4.135 and 4.144), and the standard
// headers that games expect the engine to bring.
#pragma once

#include <climits>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <string>

#include "Box.h"
#include "Object.h"
#include "Vector.h"

namespace df {

/// Do two single characters collide: |dx| <= 1 and |dy| <= 1?
bool positionsIntersect(Vector p1, Vector p2);

/// Do two boxes share a point? Touching edges do.
bool boxIntersectsBox(Box a, Box b);
/// Is a position in a box, edges included?
bool boxContainsPosition(Box b, Vector p);

/// An Object's box in world coordinates, where it is. The empty box for null.
Box getWorldBox(const Object* p_o);
/// An Object's box in world coordinates, if it were at `where`.
Box getWorldBox(const Object* p_o, Vector where);

/// From world coordinates to those of the current view (WM.getView), and back.
Vector worldToView(Vector world_pos);
Vector viewToWorld(Vector view_pos);

/// Straight distance between two positions, in cells.
float distance(Vector p1, Vector p2);

}  // namespace df
