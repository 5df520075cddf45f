// A field of obstacles and casts through it, for all engines.
#pragma once

#include <cstdint>
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

}  // namespace bench
