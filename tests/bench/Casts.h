// A field of obstacles and casts through it, for all engines.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "SortedBoxes.h"
#include "shared/values/Fixed.h"

namespace bench {

/// 1×1 boxes at random positions with all bits of a coordinate. They may overlap.
struct Field {
  Field(int n, double density);

  double side;  ///< width and height of the field, in cells
  std::vector<df::FixedBox> obstacles;
  SortedBoxes sorted;
};

/// A move of a 1×1 box from one position to another.
struct Cast {
  df::FixedVector from;  ///< position of the centre
  df::FixedVector to;
};

/// Stands for "no obstacle" in Answer::who.
inline constexpr std::uint32_t kNobody = UINT32_MAX;

/// The obstacle that a cast hits first; of several hit at once, the one with the lowest index.
struct Answer {
  std::uint32_t who = kNobody;
  double time = 1;
  df::FixedVector position;  ///< centre just before the contact
};

/// Casts with Box2D 2.4.1. It has no box cast, but its tree's ray cast is equivalent if the obstacles are
/// enlarged by the mover's half size (their Minkowski sum) and the tree's callback tests the slabs.
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
