#include "engine/managers/SceneGraph.h"

#include "engine/world/World.h"

namespace df {

namespace {

template <class Wanted>
ObjectList pickObjects(Wanted wanted) {
  const ObjectList all = World::current().getAllObjects(true);
  ObjectList list;
  for (int i = 0; i < all.getCount(); ++i) {
    if (wanted(*all[i])) list.insert(all[i]);
  }
  return list;
}

}  // namespace

ObjectList SceneGraph::activeObjects() const {
  return World::current().getAllObjects();
}

ObjectList SceneGraph::inactiveObjects() const {
  return pickObjects([](const Object& o) { return !o.isActive(); });
}

ObjectList SceneGraph::solidObjects() const {
  return World::current().solidObjects();
}

ObjectList SceneGraph::visibleObjects(int altitude) const {
  return pickObjects(
      [=](const Object& o) { return o.isActive() && o.isVisible() && o.getAltitude() == altitude; });
}

ObjectList SceneGraph::objectsOfType(const std::string& type) const {
  return World::current().objectsOfType(type);
}

}  // namespace df
