#include "utility.h"

#include "World.h"

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

}  // namespace df
