// A field of obstacles and sweeps through it: the same for all who are asked, with the answers that are
// right.
#pragma once

#include <cstdint>
#include <vector>

#include "Bins.h"
#include "Impact.h"
#include "shared/values/Fixed.h"

namespace bench {

/// 1×1 boxes at random positions, to the last bit of a coordinate. They may overlap.
struct Field {
  Field(int n, double density);

  double side;  ///< in cells
  std::vector<df::FixedBox> obstacles;
  Bins bins;
};

/// A 1×1 box that is to go from one position to another.
struct Cast {
  df::FixedVector from;  ///< of its middle
  df::FixedVector to;
};

/// Nobody.
inline constexpr std::uint32_t kNobody = UINT32_MAX;

/// Whom a cast meets first: of several at the same time, the first obstacle.
struct Answer {
  std::uint32_t who = kNobody;
  double time = 1;
  df::FixedVector position;  ///< of the middle just before
};

/// So many casts from random places in the field in random directions, each `length` cells long. None touches
/// an obstacle where it begins, and none leaves the field, if that is more than twice as wide.
std::vector<Cast> drawCasts(const Field& field, int count, double length);

/// The exact answer, by looking at everybody near the path.
Answer solve(const Field& field, const Cast& cast);

/// The same obstacle at the same time (to 1e-9 of the way), and exactly the same place to stop?
bool areEqual(const Answer& a, const Answer& b);

}  // namespace bench
