#include "Scene.h"

#include <algorithm>
#include <numbers>

namespace bench::physics {

double Part::area() const {
  return isCircle() ? std::numbers::pi * radius * radius : 4 * half_width * half_height;
}

double Body::mass() const {
  double area = 0;
  for (const Part& part : parts) area += part.area();
  return density * area;
}

int Scene::countDynamic() const {
  return static_cast<int>(std::count_if(bodies.begin(), bodies.end(),
                                        [](const Body& body) { return body.motion == Motion::DYNAMIC; }));
}

}  // namespace bench::physics
