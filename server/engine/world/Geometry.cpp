#include "engine/world/Geometry.h"

#include <algorithm>
#include <cmath>

#include "engine/world/Object.h"
#include "engine/world/World.h"
#include "shared/math/Elementary.h"

namespace df {

bool positionsIntersect(Vector p1, Vector p2) {
  return std::fabs(p1.x() - p2.x()) <= 1 && std::fabs(p1.y() - p2.y()) <= 1;
}

bool boxIntersectsBox(Box a, Box b) {
  const Vector ca = a.getCorner();
  const Vector cb = b.getCorner();
  return ca.x() <= cb.x() + b.width() && cb.x() <= ca.x() + a.width() && ca.y() <= cb.y() + b.height() &&
         cb.y() <= ca.y() + a.height();
}

bool boxContainsPosition(Box b, Vector p) {
  return boxIntersectsBox(b, Box(p, 0, 0));
}

Box getWorldBox(const Object* p_o) {
  return p_o == nullptr ? Box() : getWorldBox(p_o, p_o->getPosition());
}

Box getWorldBox(const Object* p_o, Vector where) {
  if (p_o == nullptr) return {};
  Box box = p_o->getBox();
  box.setCorner(box.getCorner() + where);
  return box;
}

Vector worldToView(Vector world_pos) {
  return world_pos - World::current().getView().getCorner();
}

Vector viewToWorld(Vector view_pos) {
  return view_pos + World::current().getView().getCorner();
}

float distance(Vector p1, Vector p2) {
  return (p1 - p2).getMagnitude();
}

float distance(const Object* p_o1, const Object* p_o2) {
  return p_o1 == nullptr || p_o2 == nullptr ? -1 : distance(p_o1->getPosition(), p_o2->getPosition());
}

bool valueInRange(float value, float min, float max) {
  return value >= min && value <= max;
}

bool boxContainsBox(Box b1, Box b2) {
  const Vector far = b2.getCorner() + Vector(b2.width(), b2.height());
  return boxContainsPosition(b1, b2.getCorner()) && boxContainsPosition(b1, far);
}

namespace {

double cross(Vector a, Vector b) {
  return a.x() * b.y() - a.y() * b.x();
}

}  // namespace

bool lineIntersectsLine(Line line1, Line line2) {
  const Vector way1 = line1.getP2() - line1.getP1();
  const Vector way2 = line2.getP2() - line2.getP1();
  const Vector between = line2.getP1() - line1.getP1();
  const double area = cross(way1, way2);
  if (area == 0) return false;
  const double part1 = cross(between, way2) / area;
  const double part2 = cross(between, way1) / area;
  return part1 >= 0 && part1 <= 1 && part2 >= 0 && part2 <= 1;
}

// Computes the part of the segment, from 0 to 1, that lies between the box's sides, axis by axis.
bool lineIntersectsBox(Line line, Box b) {
  const Vector displacement = line.getP2() - line.getP1();
  const Vector low = b.getCorner() - line.getP1();
  const Vector high = low + Vector(b.width(), b.height());
  double begin = 0;
  double end = 1;
  const auto clip = [&](double step, double from, double to) {
    if (step == 0) return from <= 0 && to >= 0;
    begin = std::max(begin, std::min(from / step, to / step));
    end = std::min(end, std::max(from / step, to / step));
    return begin <= end;
  };
  return clip(displacement.x(), low.x(), high.x()) && clip(displacement.y(), low.y(), high.y());
}

bool circleIntersectsBox(Circle circle, Box b) {
  const Vector low = b.getCorner();
  const Vector centre = circle.getCenter();
  const Vector nearest(std::clamp(centre.x(), low.x(), low.x() + b.width()),
                       std::clamp(centre.y(), low.y(), low.y() + b.height()));
  if (distance(centre, nearest) > circle.getRadius()) return false;
  if (!World::current().compat()) return true;
  const double room = std::min({centre.x() - low.x(), low.x() + b.width() - centre.x(), centre.y() - low.y(),
                                low.y() + b.height() - centre.y()});
  return room <= circle.getRadius();
}

Vector getNormal(const Object* p_o1, const Object* p_o2) {
  if (p_o1 == nullptr || p_o2 == nullptr) return {};
  const Box a = getWorldBox(p_o1);
  const Box b = getWorldBox(p_o2);
  if (!boxIntersectsBox(a, b)) return {};
  const auto middle = [](const Box& box) {
    return box.getCorner() + Vector(box.width() / 2, box.height() / 2);
  };
  const Vector apart = middle(a) - middle(b);
  if (apart == Vector()) return {};
  const double x = (a.width() + b.width()) / 2 - std::fabs(apart.x());
  const double y = (a.height() + b.height()) / 2 - std::fabs(apart.y());
  if (x < y) return {apart.x() < 0 ? -1.0 : 1.0, 0};
  return {0, apart.y() < 0 ? -1.0 : 1.0};
}

float vectorToAngle(Vector v) {
  if (v == Vector()) return 0;
  const double degrees = math::atan2(v.y(), v.x()) * (180 / 3.14159265358979323846);
  return static_cast<float>(degrees < 0 ? degrees + 360 : degrees);
}

}  // namespace df
