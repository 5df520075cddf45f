// Lists of the Objects of the current world by what they are, for games that ask the published engine's scene
// graph. (Naiad's own order of things is WorldStore.h.)
#pragma once

#include <string>

#include "Object.h"
#include "ObjectList.h"

namespace df {

class SceneGraph {
 public:
  /// All active Objects, in creation order, as those below.
  ObjectList activeObjects() const;
  ObjectList inactiveObjects() const;  ///< All inactive Objects.
  /// The active HARD and SOFT ones.
  ObjectList solidObjects() const;
  /// The active visible ones of this altitude.
  ObjectList visibleObjects(int altitude) const;
  ObjectList objectsOfType(const std::string& type) const;  ///< As WM.objectsOfType().
};

}  // namespace df
