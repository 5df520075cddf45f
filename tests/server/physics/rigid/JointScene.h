// Scenes of jointed bodies without shapes for tests, and functions that measure them. Times are in seconds.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "physics/rigid/RigidWorld.h"
#include "tests/server/physics/Joints.h"
#include "tests/server/physics/SceneRandom.h"

namespace naiad::physics::test {

inline constexpr double kTick = 1.0 / 30;
inline constexpr Vec2 kDown = {0, 10};  // gravity in cells per second²

struct JointScene {
  RigidWorld world{RigidOptions{.may_sleep = false}};
  std::vector<int> joints;

  int point(Vec2 place, double inverse_mass = 1) {
    RigidBody body;
    body.place = placeAt(place);
    body.inverse_mass = inverse_mass;
    return world.add(body, std::span<const ConvexShape>{});
  }
  int rigid(Vec2 place, double mass, double inertia) {
    const int id = point(place, 1 / mass);
    change(id).inverse_inertia = 1 / inertia;
    apply();
    return id;
  }
  /// Returns the body's state in ticks, to be changed; then call apply().
  RigidBody& change(int id) {
    m_changed_id = id;
    m_changed = world.body(id);
    return m_changed;
  }
  bool apply() { return world.set(m_changed_id, m_changed); }
  void setVelocity(int id, Vec2 velocity, double spin = 0) {
    change(id).velocity = kTick * velocity;
    m_changed.spin = kTick * spin;
    apply();
  }
  /// Adds a joint, whose numbers are in ticks.
  int join(const Joint& joint) {
    joints.push_back(world.addJoint(joint));
    return joints.back();
  }
  int join(JointKind kind, int a, int b, double length = 0) {
    return join(jointOf(kind, a, b, {.length = length}));
  }
  /// Joins two bodies, which must not be rotated, with both anchors at this point of the world.
  Joint jointAt(JointKind kind, int a, int b, Vec2 where) const {
    return jointOf(kind, a, b, {}, placeAt(where) - body(a).place, placeAt(where) - body(b).place);
  }
  int joinAt(JointKind kind, int a, int b, Vec2 where) { return join(jointAt(kind, a, b, where)); }
  void step(Vec2 gravity) {
    for (int id = 0; id < world.idLimit(); ++id) {
      if (body(id).inverse_mass == 0 || body(id).acceleration == kTick * kTick * gravity) continue;
      change(id).acceleration = kTick * kTick * gravity;
      apply();
    }
    world.step();
  }
  const RigidBody& body(int id) const { return world.body(id); }
  Vec2 velocity(int id) const { return body(id).velocity / kTick; }
  double spin(int id) const { return body(id).spin / kTick; }
  Vec2 at(int id) const { return body(id).place - Place{}; }
  double angle(int id) const { return angleOf(body(id).rotation); }
  /// Returns a joint's force in units of seconds.
  Vec2 force(int joint) const { return world.joint(joint).force / (kTick * kTick); }
  double torque(int joint) const { return world.joint(joint).torque / (kTick * kTick); }

  double kinetic() const {
    double sum = 0;
    for (int id = 0; id < world.idLimit(); ++id) {
      const RigidBody& b = body(id);
      if (b.inverse_mass > 0) sum += 0.5 * lengthSquared(velocity(id)) / b.inverse_mass;
      if (b.inverse_inertia > 0) sum += 0.5 * spin(id) * spin(id) / b.inverse_inertia;
    }
    return sum;
  }
  double energy(Vec2 gravity) const {
    double sum = kinetic();
    for (int id = 0; id < world.idLimit(); ++id) {
      if (body(id).inverse_mass > 0) sum -= dot(gravity, at(id)) / body(id).inverse_mass;
    }
    return sum;
  }
  Vec2 momentum() const {
    Vec2 sum;
    for (int id = 0; id < world.idLimit(); ++id) {
      if (body(id).inverse_mass > 0) sum += velocity(id) / body(id).inverse_mass;
    }
    return sum;
  }
  double angularMomentum() const {
    double sum = 0;
    for (int id = 0; id < world.idLimit(); ++id) {
      if (body(id).inverse_mass > 0) sum += cross(at(id), velocity(id)) / body(id).inverse_mass;
      if (body(id).inverse_inertia > 0) sum += spin(id) / body(id).inverse_inertia;
    }
    return sum;
  }
  /// Returns the largest error of the hard joints, as a length or the sine of an angle.
  double worstGap() const {
    double worst = 0;
    for (const int id : joints) {
      const Joint& its = world.joint(id);
      if (its.is_broken || its.kind == JointKind::kMouse) continue;
      const RigidBody &a = body(its.a), &b = body(its.b);
      const Vec2 offset = (b.place - a.place) + (b.rotation * its.anchor_b - a.rotation * its.anchor_a);
      const double away = length(offset);
      const double turn = std::abs((inverse(a.rotation * its.reference) * b.rotation).s);
      double gap = 0;
      if (its.kind == JointKind::kDistance) gap = std::abs(away - its.length);
      if (its.kind == JointKind::kRope) gap = away - its.length;
      if (its.kind == JointKind::kHinge) gap = away;
      if (its.kind == JointKind::kWeld) gap = std::max(away, turn);
      if (its.kind == JointKind::kSlider)
        gap = std::max(std::abs(cross(a.rotation * its.axis, offset)), turn);
      worst = std::max(worst, gap);
    }
    return worst;
  }

 private:
  RigidBody m_changed;
  int m_changed_id = -1;
};

/// Makes a scene in which body 0 is an immovable point at the origin.
inline JointScene nailed() {
  JointScene scene;
  scene.point({0, 0}, 0);
  return scene;
}

/// Makes a rope of `links` rods from (0, 0) along x. Its last point has `ratio` times the mass of the others.
inline JointScene ropeOf(int links, double ratio, bool is_free = false) {
  JointScene scene;
  scene.point({0, 0}, is_free ? 1 : 0);
  for (int i = 1; i <= links; ++i) {
    scene.point({static_cast<double>(i), 0}, i == links ? 1 / ratio : 1);
    scene.join(JointKind::kDistance, i - 1, i, 1);
  }
  return scene;
}

}  // namespace naiad::physics::test
