// Lists of the Objects of the current world by their properties, for games that use the published engine's
// scene graph. (Naiad itself uses WorldStore.h.)
#pragma once

#include <string>

#include "Object.h"
#include "ObjectList.h"

namespace df {

class SceneGraph {
 public:
  /// Returns all active Objects. All functions here list Objects in creation order.
  ObjectList activeObjects() const;
  ObjectList inactiveObjects() const;  ///< All inactive Objects.
  /// Returns the active HARD and SOFT Objects.
  ObjectList solidObjects() const;
  /// Returns the active visible Objects of this altitude.
  ObjectList visibleObjects(int altitude) const;
  ObjectList objectsOfType(const std::string& type) const;  ///< See WM.objectsOfType().
};

}  // namespace df
