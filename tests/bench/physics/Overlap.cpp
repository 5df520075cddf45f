#include "Overlap.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace lab {
namespace {

// Position of a body or shape, and its axes.
struct Pose {
  Vec at;
  Vec across{1, 0};
  Vec down{0, 1};

  Pose() = default;
  explicit Pose(const BodyState& state)
      : at(state.position), across{std::cos(state.angle), std::sin(state.angle)}, down{-across.y, across.x} {}
  Vec toWorld(Vec local) const { return at + local.x * across + local.y * down; }
  Vec toLocal(Vec world) const { return {dot(world - at, across), dot(world - at, down)}; }
};

// A shape at its body's pose.
struct Placed {
  Pose pose;  // pose of its centre
  Shape shape;
  Vec reach;  // half the size of its upright bounding box
  std::size_t body = 0;
  bool dynamic = false;

  bool isCircle() const { return shape.kind == Shape::Kind::CIRCLE; }
  double left() const { return pose.at.x - reach.x; }
  double right() const { return pose.at.x + reach.x; }
};

// Returns the extent of a box from its centre along a unit vector.
double reachAlong(const Placed& box, Vec way) {
  return box.shape.half.x * std::abs(dot(box.pose.across, way)) +
         box.shape.half.y * std::abs(dot(box.pose.down, way));
}

Placed place(const Shape& shape, const Pose& body) {
  Placed placed{body, shape, {shape.radius, shape.radius}};
  placed.pose.at = body.toWorld(shape.centre);
  if (!placed.isCircle()) placed.reach = {reachAlong(placed, {1, 0}), reachAlong(placed, {0, 1})};
  return placed;
}

// Returns the length of the shortest shift that separates two boxes. It is along a side of one of them.
double depthOfBoxes(const Placed& a, const Placed& b) {
  const Vec apart = b.pose.at - a.pose.at;
  double least = std::numeric_limits<double>::infinity();
  for (const Vec way : {a.pose.across, a.pose.down, b.pose.across, b.pose.down}) {
    least = std::min(least, reachAlong(a, way) + reachAlong(b, way) - std::abs(dot(apart, way)));
  }
  return least;
}

double depthInBox(const Placed& box, const Placed& circle) {
  const Vec local = box.pose.toLocal(circle.pose.at);
  // Distance beyond the sides; negative if inside.
  const double out_x = std::abs(local.x) - box.shape.half.x;
  const double out_y = std::abs(local.y) - box.shape.half.y;
  if (out_x <= 0 && out_y <= 0) return circle.shape.radius - std::max(out_x, out_y);
  return circle.shape.radius - std::hypot(std::max(out_x, 0.0), std::max(out_y, 0.0));
}

double depthOf(const Placed& a, const Placed& b) {
  if (a.isCircle() && b.isCircle()) {
    return a.shape.radius + b.shape.radius - length(b.pose.at - a.pose.at);
  }
  if (a.isCircle()) return depthInBox(b, a);
  if (b.isCircle()) return depthInBox(a, b);
  return depthOfBoxes(a, b);
}

bool mayOverlap(const Placed& a, const Placed& b) {
  return a.body != b.body && (a.dynamic || b.dynamic) &&
         std::abs(a.pose.at.y - b.pose.at.y) < a.reach.y + b.reach.y;
}

}  // namespace

std::vector<BodyState> statesOf(const Scene& scene, const Simulation& simulation) {
  std::vector<BodyState> states;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    states.push_back(simulation.body(static_cast<int>(i)));
  }
  return states;
}

double deepestOverlap(const std::vector<Body>& bodies, const std::vector<BodyState>& states) {
  std::vector<Placed> all;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    for (const Shape& shape : bodies[i].shapes) {
      all.push_back(place(shape, Pose(states[i])));
      all.back().body = i;
      all.back().dynamic = bodies[i].motion == Motion::DYNAMIC;
    }
  }
  // Finds the pairs that may overlap by sorting all shapes along x.
  std::sort(all.begin(), all.end(), [](const Placed& a, const Placed& b) { return a.left() < b.left(); });
  double deepest = 0;
  for (auto a = all.begin(); a != all.end(); ++a) {
    for (auto b = a + 1; b != all.end() && b->left() < a->right(); ++b) {
      if (mayOverlap(*a, *b)) deepest = std::max(deepest, depthOf(*a, *b));
    }
  }
  return deepest;
}

double widestHinge(const Scene& scene, const std::vector<BodyState>& states) {
  const auto placeOf = [&](int body, Vec anchor) {  // all bodies of these scenes start upright
    if (body < 0) return anchor;
    const auto index = static_cast<std::size_t>(body);
    return Pose(states[index]).toWorld(anchor - scene.bodies[index].position);
  };
  double widest = 0;
  for (const Joint& hinge : scene.joints) {
    widest = std::max(widest, length(placeOf(hinge.b, hinge.anchor_b) - placeOf(hinge.a, hinge.anchor_a)));
  }
  return widest;
}

double widestStretch(const Scene& scene, const std::vector<BodyState>& states) {
  double most = 0;
  for (const Joint& rod : scene.joints) {
    const Vec now =
        states[static_cast<std::size_t>(rod.b)].position - states[static_cast<std::size_t>(rod.a)].position;
    most = std::max(most, length(now) / length(rod.anchor_b - rod.anchor_a) - 1);
  }
  return most;
}

long countLost(const Scene& scene, const Simulation& simulation) {
  const std::vector<BodyState> states = statesOf(scene, simulation);
  const Room& room = scene.room;
  const Pose frame = room.frame < 0 ? Pose() : Pose(states[static_cast<std::size_t>(room.frame)]);
  long lost = simulation.frozen();
  for (std::size_t i = 0; i < states.size(); ++i) {
    if (scene.bodies[i].motion != Motion::DYNAMIC) continue;
    const Vec at = frame.toLocal(states[i].position);
    const bool is_inside =
        at.x > room.lower.x && at.x < room.upper.x && at.y > room.lower.y && at.y < room.upper.y;
    if (!is_inside || !std::isfinite(states[i].angle)) ++lost;
  }
  return lost;
}

}  // namespace lab
