// Tests which positions, boxes, lines and circles touch (book, Listings 4.107, 4.124, 4.135 and 4.144). Edges
// belong to the figure that they bound. Lengths are in cells.
#pragma once

#include "Box.h"
#include "Circle.h"
#include "Line.h"
#include "Vector.h"

namespace df {

class Object;

/// True if two single characters collide: |dx| <= 1 and |dy| <= 1.
bool positionsIntersect(Vector p1, Vector p2);

/// True if two boxes share a point; touching edges are enough.
bool boxIntersectsBox(Box a, Box b);
/// True if a position is in a box, edges included.
bool boxContainsPosition(Box b, Vector p);

/// Returns an Object's box in world coordinates, at its position. Returns the empty box for null.
Box getWorldBox(const Object* p_o);
/// Like getWorldBox(p_o), but as if the Object were at `where`.
Box getWorldBox(const Object* p_o, Vector where);

/// Convert world coordinates to those of the current view (WM.getView), and back.
Vector worldToView(Vector world_pos);
Vector viewToWorld(Vector view_pos);

/// Returns the straight distance between two positions, in cells.
float distance(Vector p1, Vector p2);
/// Returns the distance between the positions of two Objects; -1 if one is null.
float distance(const Object* p_o1, const Object* p_o2);

/// True if min <= value <= max.
bool valueInRange(float value, float min, float max);
/// True if box 1 contains all of box 2.
bool boxContainsBox(Box b1, Box b2);
/// True if two line segments cross; false for parallel ones.
bool lineIntersectsLine(Line line1, Line line2);
/// True if a part of the segment is in the box.
bool lineIntersectsBox(Line line, Box b);
/// True if the circle and the box share a point (compat: false if the circle lies wholly inside the box).
bool circleIntersectsBox(Circle circle, Box b);
/// Returns the normal of the side of Object 2 that Object 1, the mover, hit: a vector of length 1 away from
/// Object 2, along the axis on which their boxes overlap least. Returns (0,0) if they do not touch, if the
/// middles of their boxes coincide, or if one is null.
Vector getNormal(const Object* p_o1, const Object* p_o2);
/// Returns the direction of a vector in degrees, 0 to 360: 0 to the right, 90 downward.
float vectorToAngle(Vector v);

}  // namespace df
