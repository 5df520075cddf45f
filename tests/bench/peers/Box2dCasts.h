// Sweeps with Box2D 2.4.1. It has no box cast, but its tree's ray cast is equivalent if the obstacles are
// enlarged by the mover's half size (their Minkowski sum) and the tree's callback tests the slabs.
#pragma once

#include <memory>
#include <vector>

#include "Casts.h"

namespace bench {

class Box2dCasts {
 public:
  explicit Box2dCasts(const Field& field);
  ~Box2dCasts();

  /// Returns the first obstacle and the time of contact, without a position.
  Answer cast(const Cast& cast) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> m_p_tree;
};

}  // namespace bench
