// Scenes of jointed bodies for tests, and functions that measure them.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "physics/joint/JointSolver.h"
#include "tests/server/physics/SceneRandom.h"

namespace naiad::physics::test {

inline constexpr double kTick = 1.0 / 30;
inline constexpr Vec2 kDown = {0, 10};  // gravity in cells per second²

struct JointScene {
  std::vector<JointBody> bodies;
  std::vector<Joint> joints;
  JointSolver solver;

  int point(Vec2 place, double inverse_mass = 1) {
    JointBody body;
    body.place = placeAt(place);
    body.inverse_mass = inverse_mass;
    bodies.push_back(body);
    return static_cast<int>(bodies.size()) - 1;
  }
  int rigid(Vec2 place, double mass, double inertia) {
    const int body = point(place, 1 / mass);
    bodies.back().inverse_inertia = 1 / inertia;
    return body;
  }
  Joint& join(JointKind kind, int a, int b, double length = 0) {
    Joint joint;
    joint.kind = kind;
    joint.a = a;
    joint.b = b;
    joint.length = length;
    joints.push_back(joint);
    return joints.back();
  }
  /// Joins two bodies, which must not be rotated, with both anchors at this point of the world.
  Joint& joinAt(JointKind kind, int a, int b, Vec2 where) {
    Joint& joint = join(kind, a, b);
    joint.anchor_a = placeAt(where) - bodies[static_cast<std::size_t>(a)].place;
    joint.anchor_b = placeAt(where) - bodies[static_cast<std::size_t>(b)].place;
    return joint;
  }
  int connect() { return solver.connect(bodies, joints); }
  int step(Vec2 gravity, JointOptions options = {}, double h = kTick) {
    return solver.step(bodies, joints, h, gravity, options);
  }
  const JointBody& body(int i) const { return bodies[static_cast<std::size_t>(i)]; }
  Vec2 at(int i) const { return body(i).place - Place{}; }

  double kinetic() const {
    double sum = 0;
    for (const JointBody& b : bodies) {
      if (b.inverse_mass > 0) sum += 0.5 * lengthSquared(b.velocity) / b.inverse_mass;
      if (b.inverse_inertia > 0) sum += 0.5 * b.spin * b.spin / b.inverse_inertia;
    }
    return sum;
  }
  double energy(Vec2 gravity) const {
    double sum = kinetic();
    for (const JointBody& b : bodies) {
      if (b.inverse_mass > 0) sum -= dot(gravity, b.place - Place{}) / b.inverse_mass;
    }
    return sum;
  }
  Vec2 momentum() const {
    Vec2 sum;
    for (const JointBody& b : bodies) {
      if (b.inverse_mass > 0) sum += b.velocity / b.inverse_mass;
    }
    return sum;
  }
  double angularMomentum() const {
    double sum = 0;
    for (const JointBody& b : bodies) {
      if (b.inverse_mass > 0) sum += cross(b.place - Place{}, b.velocity) / b.inverse_mass;
      if (b.inverse_inertia > 0) sum += b.spin / b.inverse_inertia;
    }
    return sum;
  }
  Vec2 anchorOffset(const Joint& joint) const {
    const JointBody &a = body(joint.a), &b = body(joint.b);
    return (b.place - a.place) + (b.rotation * joint.anchor_b - a.rotation * joint.anchor_a);
  }
  /// Returns the largest error of the hard joints, as a length or the sine of an angle.
  double worstGap() const {
    double worst = 0;
    for (const Joint& joint : joints) {
      if (joint.is_broken || joint.kind == JointKind::kMouse) continue;
      const Vec2 displacement = anchorOffset(joint);
      const Rotation turned = inverse(body(joint.a).rotation * joint.reference) * body(joint.b).rotation;
      const double away = length(displacement), turn = std::abs(turned.s);
      double gap = 0;
      if (joint.kind == JointKind::kDistance) gap = std::abs(away - joint.length);
      if (joint.kind == JointKind::kRope) gap = away - joint.length;
      if (joint.kind == JointKind::kHinge) gap = away;
      if (joint.kind == JointKind::kWeld) gap = std::max(away, turn);
      if (joint.kind == JointKind::kSlider)
        gap = std::max(std::abs(cross(body(joint.a).rotation * joint.axis, displacement)), turn);
      worst = std::max(worst, gap);
    }
    return worst;
  }
};

/// Makes a scene in which body 0 is an immovable point at the origin.
inline JointScene nailed() {
  JointScene scene;
  scene.point({0, 0}, 0);
  return scene;
}

/// Makes a rope of `links` rods from (0, 0) along x. Its last point has `ratio` times the mass of the others.
inline JointScene ropeOf(int links, double ratio) {
  JointScene scene = nailed();
  for (int i = 1; i <= links; ++i) {
    scene.point({static_cast<double>(i), 0}, i == links ? 1 / ratio : 1);
    scene.join(JointKind::kDistance, i - 1, i, 1);
  }
  scene.connect();
  return scene;
}

}  // namespace naiad::physics::test
