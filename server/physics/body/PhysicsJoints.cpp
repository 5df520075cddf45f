// Functions of PhysicsManager that make joints.
#include <cmath>

#include "engine/world/World.h"
#include "physics/body/Body.h"
#include "physics/body/BodyLayer.h"
#include "physics/body/PhysicsManager.h"

namespace df {

namespace {

using naiad::physics::BodyJoints;
using naiad::physics::BodyLayer;
using naiad::physics::BodyTable;
using naiad::physics::inverse;
using naiad::physics::JointKind;
using naiad::physics::Place;
using naiad::physics::Rotation;
using naiad::physics::Vec2;
using RawJoint = naiad::physics::Joint;

RawJoint jointOf(JointKind kind) {
  RawJoint joint;
  joint.kind = kind;
  return joint;
}

}  // namespace

Joint PhysicsManager::refuseJoint(const char* what) const {
  refuseAs(what);
  return {};
}

// Adds a joint between two bodies, with the points as anchors, converted to the bodies' coordinates.
Joint PhysicsManager::add(const char* what, RawJoint joint, Body* p_a, Body* p_b, Vector point_a,
                          Vector point_b) const {
  if (p_b == nullptr && joint.kind != JointKind::kSlider && joint.kind != JointKind::kMotor) {
    std::swap(p_a, p_b);
    std::swap(point_a, point_b);
  }
  const auto& table = BodyLayer::of(World::current()).table();
  const auto isHere = [&](const Body* p_body) { return p_body == nullptr || p_body->m_table == table; };
  if ((p_a == nullptr && p_b == nullptr) || p_a == p_b || !isHere(p_a) || !isHere(p_b))
    return refuseJoint(what);
  if (!toFixed(point_a) || !toFixed(point_b)) return refuseJoint(what);
  const Place at_a = table->metric.placeAtCells(point_a), at_b = table->metric.placeAtCells(point_b);
  Rotation rotation[2];
  Place world;
  const auto attach = [&](const Body* p_body, Vector point, Place at, int& row, Vec2& anchor,
                          Rotation& turned) {
    row = BodyJoints::kWorld;
    anchor = {};
    if (p_body == nullptr) {
      world = at;
      return;
    }
    p_body->syncFromStore();
    row = static_cast<int>(p_body->m_index);
    turned = std::as_const(*table).form(p_body->m_index).rotation;
    const bool is_centre = point == p_body->getPosition();  // which is rounded, and must not be a lever
    anchor = is_centre ? Vec2{} : inverse(turned) * (at - p_body->row().place);
  };
  attach(p_a, point_a, at_a, joint.a, joint.anchor_a, rotation[0]);
  attach(p_b, point_b, at_b, joint.b, joint.anchor_b, rotation[1]);
  joint.reference = inverse(rotation[0]) * rotation[1];
  if (joint.kind == JointKind::kSlider) joint.axis = inverse(rotation[0]) * joint.axis;
  const bool has_length = joint.kind == JointKind::kDistance || joint.kind == JointKind::kRope ||
                          joint.kind == JointKind::kSpring;
  if (has_length && joint.length == 0) joint.length = length(at_b - at_a);
  if (joint.kind == JointKind::kMouse) joint.target = at_b;
  RawJoint checked = joint;
  checked.a = 0;
  checked.b = 1;
  if (!naiad::physics::isValid(checked, 2)) return refuseJoint(what);
  return {table, table->joints.add(joint, world)};
}

Joint PhysicsManager::addDistance(Body* p_a, Body* p_b, Vector point_a, Vector point_b) {
  return add("addDistance", jointOf(JointKind::kDistance), p_a, p_b, point_a, point_b);
}

Joint PhysicsManager::addDistance(Body* p_a, Body* p_b) {
  if (p_a == nullptr || p_b == nullptr) return refuseJoint("addDistance");
  return addDistance(p_a, p_b, p_a->getPosition(), p_b->getPosition());
}

Joint PhysicsManager::addRope(Body* p_a, Body* p_b, Vector point_a, Vector point_b) {
  return add("addRope", jointOf(JointKind::kRope), p_a, p_b, point_a, point_b);
}

Joint PhysicsManager::addRope(Body* p_a, Body* p_b) {
  if (p_a == nullptr || p_b == nullptr) return refuseJoint("addRope");
  return addRope(p_a, p_b, p_a->getPosition(), p_b->getPosition());
}

Joint PhysicsManager::addRope(Body* p_a, Body* p_b, double length) {
  if (p_a == nullptr || p_b == nullptr || !(length > 0)) return refuseJoint("addRope");
  RawJoint joint = jointOf(JointKind::kRope);
  joint.length = length;
  return add("addRope", joint, p_a, p_b, p_a->getPosition(), p_b->getPosition());
}

Joint PhysicsManager::addHinge(Body* p_a, Body* p_b, Vector point) {
  return add("addHinge", jointOf(JointKind::kHinge), p_a, p_b, point, point);
}

Joint PhysicsManager::addWeld(Body* p_a, Body* p_b, Vector point) {
  return add("addWeld", jointOf(JointKind::kWeld), p_a, p_b, point, point);
}

Joint PhysicsManager::addSlider(Body* p_a, Body* p_b, Vector point, Vector axis) {
  RawJoint joint = jointOf(JointKind::kSlider);
  const Vec2 direction = BodyLayer::of(World::current()).table()->metric.fromCells(axis);
  const double size = length(direction);
  if (p_b == nullptr || !(size > 1e-30 && size < 1e30)) return refuseJoint("addSlider");
  joint.axis = direction / size;
  return add("addSlider", joint, p_a, p_b, point, point);
}

Joint PhysicsManager::addSpring(Body* p_a, Body* p_b, Vector point_a, Vector point_b, double stiffness,
                                double damping) {
  RawJoint joint = jointOf(JointKind::kSpring);
  joint.stiffness = stiffness;
  joint.damping = damping;
  return add("addSpring", joint, p_a, p_b, point_a, point_b);
}

Joint PhysicsManager::addSpring(Body* p_a, Body* p_b, double stiffness, double damping) {
  if (p_a == nullptr || p_b == nullptr) return refuseJoint("addSpring");
  return addSpring(p_a, p_b, p_a->getPosition(), p_b->getPosition(), stiffness, damping);
}

Joint PhysicsManager::addMotor(Body* p_a, Body* p_b, double speed, double strength) {
  RawJoint joint = jointOf(JointKind::kMotor);
  joint.speed = speed;
  joint.max_force = strength;
  if (p_b == nullptr) return refuseJoint("addMotor");
  return add("addMotor", joint, p_a, p_b, p_b->getPosition(), p_b->getPosition());
}

Joint PhysicsManager::addAngleLimit(Body* p_a, Body* p_b, double lower, double upper) {
  RawJoint joint = jointOf(JointKind::kAngleLimit);
  joint.lower = lower;
  joint.upper = upper;
  if (p_b == nullptr || !(lower <= 0 && upper >= 0)) return refuseJoint("addAngleLimit");
  return add("addAngleLimit", joint, p_a, p_b, p_b->getPosition(), p_b->getPosition());
}

Joint PhysicsManager::addMouse(Body* p_body, Vector grabbed, double strength) {
  if (p_body == nullptr) return refuseJoint("addMouse");
  // A spring that is critically damped, at one radian per tick.
  RawJoint joint = jointOf(JointKind::kMouse);
  joint.stiffness = p_body->getMass();
  joint.damping = 2 * p_body->getMass();
  joint.max_force = strength;
  return add("addMouse", joint, nullptr, p_body, grabbed, grabbed);
}

int PhysicsManager::getJointCount() const {
  return BodyLayer::of(World::current()).table()->joints.count();
}

}  // namespace df
