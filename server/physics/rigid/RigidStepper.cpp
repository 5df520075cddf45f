#include "physics/rigid/RigidStepper.h"

#include <algorithm>
#include <tuple>

namespace naiad::physics {

void RigidStepper::wakeEnds(const Joint& joint) {
  for (const int id : {joint.b, JointStore::firstOf(joint)}) {
    if (id < 0) continue;
    wakeRing(id);
    forget(id);
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

void RigidStepper::sortEvents() {
  const auto key = [](const RigidEvent& e) { return std::tuple(e.time, e.first, e.second, e.is_begin); };
  std::sort(m_events.begin(), m_events.end(),
            [&](const RigidEvent& x, const RigidEvent& y) { return key(x) < key(y); });
}

}  // namespace naiad::physics
