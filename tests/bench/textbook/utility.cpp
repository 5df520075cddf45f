#include <cmath>

#include "Book.h"

namespace textbook {

bool positionsIntersect(Vector p1, Vector p2) {
  return std::abs(p1.getX() - p2.getX()) <= 1 && std::abs(p1.getY() - p2.getY()) <= 1;
}

}  // namespace textbook
