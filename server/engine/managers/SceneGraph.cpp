#include "engine/managers/SceneGraph.h"

#include "engine/world/ObjectRegistry.h"
#include "engine/world/World.h"

namespace df {

ObjectList SceneGraph::activeObjects() const {
  return World::current().objects().getAllObjects();
}

ObjectList SceneGraph::inactiveObjects() const {
  return World::current().objects().pick([](const Object& o) { return !o.isActive(); });
}

ObjectList SceneGraph::solidObjects() const {
  return World::current().objects().solidObjects();
}

ObjectList SceneGraph::visibleObjects(int altitude) const {
  return World::current().objects().pick(
      [=](const Object& o) { return o.isActive() && o.isVisible() && o.getAltitude() == altitude; });
}

ObjectList SceneGraph::objectsOfType(const std::string& type) const {
  return World::current().objects().objectsOfType(type);
}

}  // namespace df
