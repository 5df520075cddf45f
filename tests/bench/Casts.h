// A field of obstacles and casts through it, for all engines, and the exact results of the casts.
#pragma once

#include <cstdint>
#include <vector>

#include "Bins.h"
#include "shared/values/Fixed.h"

namespace bench {

/// 1×1 boxes at random positions with all bits of a coordinate. They may overlap.
struct Field {
  Field(int n, double density);

  double side;  ///< width and height of the field, in cells
  std::vector<df::FixedBox> obstacles;
  Bins bins;
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

/// Returns this many casts of `length` cells from random places in random directions. None touches an
/// obstacle at its start. If the field is wider than twice the length, none leaves it.
std::vector<Cast> drawCasts(const Field& field, int count, double length);

/// Returns the exact answer from all obstacles near the path.
Answer solve(const Field& field, const Cast& cast);

/// True if the obstacles and final positions are equal, and the times differ by at most 1e-9 of the whole
/// way.
bool areEqual(const Answer& a, const Answer& b);

}  // namespace bench
