#include "Overlap.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

namespace bench::physics {
namespace {

// A part at its body's pose.
struct Placed {
  Pose pose;  // pose of its centre
  double half_width = 0;
  double half_height = 0;
  double radius = 0;
  double reach_x = 0;  // half the width of its upright bounding box
  double reach_y = 0;
  std::size_t body = 0;
  bool dynamic = false;

  bool isCircle() const { return radius > 0; }
  double left() const { return pose.x - reach_x; }
  double right() const { return pose.x + reach_x; }
};

Placed place(const Part& part, const Pose& pose) {
  Placed placed;
  placed.pose = pose.at(part.x, part.y);
  placed.half_width = part.half_width;
  placed.half_height = part.half_height;
  placed.radius = part.radius;
  const double c = std::abs(pose.cosine);
  const double s = std::abs(pose.sine);
  placed.reach_x = part.isCircle() ? part.radius : c * part.half_width + s * part.half_height;
  placed.reach_y = part.isCircle() ? part.radius : s * part.half_width + c * part.half_height;
  return placed;
}

// Returns the extent of a box from its centre along a unit vector.
double reachAlong(const Placed& box, double x, double y) {
  return box.half_width * std::abs(box.pose.cosine * x + box.pose.sine * y) +
         box.half_height * std::abs(box.pose.cosine * y - box.pose.sine * x);
}

// Returns the length of the shortest shift that separates two boxes. It is along a side of one of them.
double depthOfBoxes(const Placed& a, const Placed& b) {
  const double dx = b.pose.x - a.pose.x;
  const double dy = b.pose.y - a.pose.y;
  const std::array<std::array<double, 2>, 4> axes = {{{a.pose.cosine, a.pose.sine},
                                                      {-a.pose.sine, a.pose.cosine},
                                                      {b.pose.cosine, b.pose.sine},
                                                      {-b.pose.sine, b.pose.cosine}}};
  double least = std::numeric_limits<double>::infinity();
  for (const auto& [x, y] : axes) {
    least = std::min(least, reachAlong(a, x, y) + reachAlong(b, x, y) - std::abs(dx * x + dy * y));
  }
  return least;
}

double depthInBox(const Placed& box, const Placed& circle) {
  const double dx = circle.pose.x - box.pose.x;
  const double dy = circle.pose.y - box.pose.y;
  // Distance beyond the sides; negative if inside.
  const double out_x = std::abs(box.pose.cosine * dx + box.pose.sine * dy) - box.half_width;
  const double out_y = std::abs(box.pose.cosine * dy - box.pose.sine * dx) - box.half_height;
  if (out_x <= 0 && out_y <= 0) return circle.radius - std::max(out_x, out_y);
  return circle.radius - std::hypot(std::max(out_x, 0.0), std::max(out_y, 0.0));
}

double depthOf(const Placed& a, const Placed& b) {
  if (a.isCircle() && b.isCircle()) {
    return a.radius + b.radius - std::hypot(b.pose.x - a.pose.x, b.pose.y - a.pose.y);
  }
  if (a.isCircle()) return depthInBox(b, a);
  if (b.isCircle()) return depthInBox(a, b);
  return depthOfBoxes(a, b);
}

bool mayOverlap(const Placed& a, const Placed& b) {
  return a.body != b.body && (a.dynamic || b.dynamic) &&
         std::abs(a.pose.y - b.pose.y) < a.reach_y + b.reach_y;
}

}  // namespace

double deepestOverlap(const std::vector<Body>& bodies, const std::vector<Pose>& poses) {
  std::vector<Placed> all;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    for (const Part& part : bodies[i].parts) {
      all.push_back(place(part, poses[i]));
      all.back().body = i;
      all.back().dynamic = bodies[i].motion == Motion::DYNAMIC;
    }
  }
  // Finds the pairs that may overlap by sorting all parts along x.
  std::sort(all.begin(), all.end(), [](const Placed& a, const Placed& b) { return a.left() < b.left(); });
  double deepest = 0;
  for (auto a = all.begin(); a != all.end(); ++a) {
    for (auto b = a + 1; b != all.end() && b->left() < a->right(); ++b) {
      if (mayOverlap(*a, *b)) deepest = std::max(deepest, depthOf(*a, *b));
    }
  }
  return deepest;
}

double widestHinge(const Scene& scene, const std::vector<Pose>& poses) {
  const auto anchor = [&](const Hinge& hinge, int body) {
    if (body == Hinge::kWorld) return Pose{hinge.x, hinge.y};
    const auto index = static_cast<std::size_t>(body);
    return poses[index].at(hinge.x - scene.bodies[index].x, hinge.y - scene.bodies[index].y);
  };
  double widest = 0;
  for (const Hinge& hinge : scene.hinges) {
    const Pose a = anchor(hinge, hinge.a);
    const Pose b = anchor(hinge, hinge.b);
    widest = std::max(widest, std::hypot(b.x - a.x, b.y - a.y));
  }
  return widest;
}

}  // namespace bench::physics
