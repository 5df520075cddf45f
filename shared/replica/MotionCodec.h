// Motions <-> bits: exact, in as many bits as the numbers need.
//
// A position is a cell, counted from an origin, and a fraction of it; a velocity a number of steps. Both
// carry only as many bits behind the point as are not zero, so a model on a coarse grid is short and any
// other is exact all the same.
#pragma once

#include "shared/replica/Bits.h"
#include "shared/replica/Records.h"

namespace naiad {

/// `motion.position` holds at the snapshot's tick.
void writeMotion(BitWriter& out, const Motion& motion, const Origin& origin);

/// A motion and those of its bits that are the same for all clients: all but the cell, which each counts from
/// an origin of its own.
struct SharedMotion {
  SharedMotion() = default;
  SharedMotion(const Motion& m, std::uint64_t kept, int kept_count)
      : motion(m), bits(kept), count(kept_count) {}

  Motion motion;
  std::uint64_t bits = 0;
  int count = 0;  ///< of bits; 0: too many to be kept
};
SharedMotion shareMotion(const Motion& motion);
/// The same bits as writeMotion() of the motion itself.
void writeMotion(BitWriter& out, const SharedMotion& shared, const Origin& origin);

/// A motion that holds at `tick`; the reader fails where a number is out of range.
Motion readMotion(BitReader& in, std::uint32_t tick, const Origin& origin);

/// A pair of coordinates, relative to nothing.
void writeVector(BitWriter& out, df::FixedVector v);
df::FixedVector readVector(BitReader& in, df::Fixed most);

/// The fewest bits behind the point, of those that can be written, that hold both coordinates exactly.
int fractionBits(df::FixedVector v);

/// Largest magnitudes accepted. Velocities: twice what an object may have, since a model may have
/// accelerated for one tick more than its object.
inline constexpr df::Fixed kMaxWirePosition = df::Fixed{2'100'000'000} << df::kFixedBits;
inline constexpr df::Fixed kMaxWireVelocity = df::Fixed{1} << (25 + df::kFixedBits);

}  // namespace naiad
