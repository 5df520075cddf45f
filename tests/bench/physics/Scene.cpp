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

bool Room::holds(const std::vector<Pose>& poses, const Pose& pose) const {
  const Pose in = frame == Hinge::kWorld ? Pose() : poses[static_cast<std::size_t>(frame)];
  const double dx = pose.x - in.x;
  const double dy = pose.y - in.y;
  const double x = in.cosine * dx + in.sine * dy;
  const double y = in.cosine * dy - in.sine * dx;
  return x > left && x < right && y > top && y < bottom;
}

int Scene::countDynamic() const {
  return static_cast<int>(std::count_if(bodies.begin(), bodies.end(),
                                        [](const Body& body) { return body.motion == Motion::DYNAMIC; }));
}

}  // namespace bench::physics
