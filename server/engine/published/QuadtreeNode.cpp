#include "engine/published/QuadtreeNode.h"

#include "engine/managers/WorldManager.h"

namespace df {

ObjectList QuadtreeNode::getCollisions(Object* p_o, Vector where) const {
  return WM.getCollisions(p_o, where);
}

std::string QuadtreeNode::toString() const {
  return "depth " + std::to_string(m_depth) + ", " + m_boundary.toString() + ", " +
         std::to_string(m_objects.getCount()) + " objects";
}

}  // namespace df
