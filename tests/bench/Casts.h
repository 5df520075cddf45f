// A field of obstacles and casts through it, used for all engines, and the exact answers.
#pragma once

#include <cstdint>
#include <vector>

#include "Bins.h"
#include "Impact.h"
#include "shared/values/Fixed.h"

namespace bench {

/// 1×1 boxes at random positions with all bits of a coordinate. They may overlap.
struct Field {
  Field(int n, double density);

  double side;  ///< width and height in cells
  std::vector<df::FixedBox> obstacles;
  Bins bins;
};

/// A move of a 1×1 box from one position to another.
struct Cast {
  df::FixedVector from;  ///< position of the centre
  df::FixedVector to;
};

/// No obstacle.
inline constexpr std::uint32_t kNobody = UINT32_MAX;

/// The obstacle that a cast meets first. At equal times, the one with the lowest index.
struct Answer {
  std::uint32_t who = kNobody;
  double time = 1;
  df::FixedVector position;  ///< centre just before the contact
};

/// Returns this many casts of `length` cells from random places in random directions. None touches an
/// obstacle at its start, and none leaves the field if that is more than twice as wide.
std::vector<Cast> drawCasts(const Field& field, int count, double length);

/// Returns the exact answer from all obstacles near the path.
Answer solve(const Field& field, const Cast& cast);

/// True if obstacle and final position are equal, and the times too, within 1e-9 of the way.
bool areEqual(const Answer& a, const Answer& b);

}  // namespace bench
