// Positions, boxes, lines and circles: what touches what (book, Listings 4.107, 4.124, 4.135 and 4.144).
// Edges belong to what they bound. Lengths in cells.
#pragma once

#include "Box.h"
#include "Circle.h"
#include "Line.h"
#include "Vector.h"

namespace df {

class Object;

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
/// Between the positions of two Objects; -1 if one is null.
float distance(const Object* p_o1, const Object* p_o2);

/// min <= value <= max?
bool valueInRange(float value, float min, float max);
/// Does box 1 contain all of box 2?
bool boxContainsBox(Box b1, Box b2);
/// Do two line segments cross? Parallel ones do not.
bool lineIntersectsLine(Line line1, Line line2);
/// Is a part of the segment in the box?
bool lineIntersectsBox(Line line, Box b);
/// Do they share a point? (compat: not if the circle lies wholly inside the box.)
bool circleIntersectsBox(Circle circle, Box b);
/// From which side Object 1, which moved, came upon Object 2: a vector of length 1 away from Object 2, along
/// the axis on which their boxes overlap least; (0,0) if they do not touch, or if the position of Object 1 is
/// the middle of Object 2.
Vector getNormal(const Object* p_o1, const Object* p_o2);
/// The direction of a vector in degrees, 0 to 360: 0 to the right, 90 downward.
float vectorToAngle(Vector v);

}  // namespace df
