#include "physics/rigid/RigidStepper.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "physics/geometry/Index.h"

namespace naiad::physics {

void RigidStepper::wakeEnds(const Joint& joint) {
  for (const int id : {joint.b, JointStore::firstOf(joint)}) {
    if (id < 0) continue;
    wakeRing(id);
    forgetBeside(id);
  }
}

int RigidStepper::addJoint(const Joint& joint, bool may_touch) {
  if (!isValid(joint, idLimit()) || !exists(joint.b)) return -1;
  if (joint.kind != JointKind::kMouse && !exists(joint.a)) return -1;
  wakeEnds(joint);
  m_joints_changed = true;
  return joints().add(joint, may_touch);
}

bool RigidStepper::setJoint(int id, const Joint& joint) {
  if (!jointExists(id) || !isValid(joint, idLimit()) || !joints().set(id, joint)) return false;
  wakeEnds(joint);
  return true;
}

bool RigidStepper::removeJoint(int id) {
  if (!jointExists(id)) return false;
  wakeEnds(joint(id));
  joints().remove(id);
  m_joints_changed = true;
  return true;
}

void RigidStepper::removeJointsOf(int body) {
  const std::vector<int> ids = joints().ids();
  for (const int id : ids) {
    if (joint(id).b == body || JointStore::firstOf(joint(id)) == body) removeJoint(id);
  }
}

void RigidStepper::setFrictionParts(int id, std::span<const FrictionPart> parts) {
  std::erase_if(m_friction_parts, [id](const PartOfBody& old) { return old.id == id; });
  for (const FrictionPart& part : parts) m_friction_parts.push_back({id, part});
}

// Returns the friction of the part that is nearest to a point of a body.
double RigidStepper::frictionAt(int id, Vec2 point) const {
  double friction = body(id).friction, nearest = 1e300;
  if (isMovable(body(id))) return friction;
  for (const PartOfBody& its : m_friction_parts) {
    if (its.id != id) continue;
    const Bounds& box = its.part.bounds;
    const double x = std::max({box.lower.x - point.x, point.x - box.upper.x, 0.0});
    const double y = std::max({box.lower.y - point.y, point.y - box.upper.y, 0.0});
    if (x + y < nearest) nearest = x + y, friction = its.part.friction;
  }
  return friction;
}

double RigidStepper::frictionOf(int a, int b, const Manifold& manifold) const {
  double sum = 0;
  for (std::int32_t i = 0; i < manifold.count; ++i) {
    const ManifoldPoint& point = manifold.points[at(i)];
    sum += std::sqrt(frictionAt(a, point.anchor_a) * frictionAt(b, point.anchor_b));
  }
  return sum / manifold.count;
}

void RigidStepper::sortEvents() {
  const auto key = [](const RigidEvent& e) { return std::tuple(e.time, e.first, e.second, e.is_begin); };
  std::sort(m_events.begin(), m_events.end(),
            [&](const RigidEvent& x, const RigidEvent& y) { return key(x) < key(y); });
}

}  // namespace naiad::physics
