// Encodes motions as bits, and decodes them: exactly, with as few bits as the numbers need.
//
// A position is a cell, relative to an origin, and a fraction of a cell; a velocity is in cells per tick.
// Most zero bits at the end of fractions are omitted, so motions on a coarse grid are short, and all others
// are still exact.
#pragma once

#include "shared/replica/Bits.h"
#include "shared/replica/Records.h"

namespace naiad {

/// Appends a motion; `motion.position` must hold at the snapshot's tick.
void writeMotion(BitWriter& out, const Motion& motion, const Origin& origin);

/// A motion with the bits that are equal for all clients: all but the cell, which depends on the origin.
struct SharedMotion {
  SharedMotion() = default;
  SharedMotion(const Motion& m, std::uint64_t kept, int kept_count)
      : motion(m), bits(kept), count(kept_count) {}

  Motion motion;
  std::uint64_t bits = 0;
  int count = 0;  ///< number of bits; 0: too many to store
};
SharedMotion shareMotion(const Motion& motion);
/// Appends the bits that writeMotion() of the motion itself would append.
void writeMotion(BitWriter& out, const SharedMotion& shared, const Origin& origin);

/// Reads a motion that holds at `tick`. `in` fails if a number is out of range.
Motion readMotion(BitReader& in, std::uint32_t tick, const Origin& origin);

/// Appends a pair of absolute coordinates.
void writeVector(BitWriter& out, df::FixedVector v);
df::FixedVector readVector(BitReader& in, df::Fixed most);

/// Returns the smallest encodable number of fractional bits that holds both coordinates exactly.
int fractionBits(df::FixedVector v);

/// Largest accepted magnitudes. For velocities, it is twice an object's limit, because a model may have
/// accelerated for one tick more than its object.
inline constexpr df::Fixed kMaxWirePosition = df::Fixed{2'100'000'000} << df::kFixedBits;
inline constexpr df::Fixed kMaxWireVelocity = df::Fixed{1} << (25 + df::kFixedBits);

}  // namespace naiad
