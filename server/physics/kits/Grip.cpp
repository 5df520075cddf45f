#include "physics/kits/Grip.h"

#include "engine/managers/WorldManager.h"
#include "physics/body/Body.h"
#include "physics/body/PhysicsManager.h"
#include "physics/body/SoftObject.h"

namespace df {

int Grip::grab(Vector where, double strength) {
  release();
  const ObjectList things = WM.objectsSeenAt(where);
  for (int i = 0; i < things.getCount(); ++i) {
    if (auto* p_soft = dynamic_cast<SoftBody*>(things[i])) {
      if (p_soft->isGrabbed()) continue;
      if (p_soft->grab(where, strength * p_soft->getMass()) != 0) return -1;
      m_soft = p_soft;
      return 0;
    }
    if (auto* p_body = dynamic_cast<Body*>(things[i])) {
      m_joint = PM.addMouse(p_body, where, strength * p_body->getMass());
      return m_joint.exists() ? 0 : -1;
    }
  }
  return -1;
}

int Grip::dragTo(Vector where) {
  if (SoftBody* p_soft = m_soft.get()) return p_soft->dragTo(where);
  return m_joint.setTarget(where);
}

void Grip::release() {
  m_joint.remove();
  if (SoftBody* p_soft = m_soft.get()) p_soft->release();
  m_soft = nullptr;
}

bool Grip::isHolding() const {
  return m_joint.exists() || m_soft;
}

}  // namespace df
