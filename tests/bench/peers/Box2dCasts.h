// Sweeps with Box2D 2.4.1. It has no box cast, but a ray cast through its tree, which is the same if the
// obstacles are larger by the mover's half size (their Minkowski sum) and the tree's callback tests the
// slabs.
#pragma once

#include <memory>
#include <vector>

#include "Casts.h"

namespace bench {

class Box2dCasts {
 public:
  explicit Box2dCasts(const Field& field);
  ~Box2dCasts();

  /// Whom it meets first, and when; without a position.
  Answer cast(const Cast& cast) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> m_p_tree;
};

}  // namespace bench
