// Soft bodies that games ask for by name: rope, cloth, blob, beam.
//
// What comes back is plain data, to be changed (pins, forces, friction, damping) before it is added to a
// SoftWorld. Numbers that make no sense make a body that isSound() refuses.
#pragma once

#include "physics/soft/SoftBody.h"

namespace naiad::physics {

/// A rope or chain of equal links from `from`, where its place is, over `displacement`. The mass is spread
/// evenly: half a link's on each end. `stretch` is EA (a link's stiffness is EA over its length), `bend` is
/// EI; 0 for none.
SoftBody makeRope(const Place& from, Vec2 displacement, int links, double mass, double stretch,
                  double bend = 0);

/// A grid of (columns + 1) × (rows + 1) nodes; node (i, j) is number j + i · (rows + 1), so that the long
/// side should be the columns'. Threads along and across have the stiffness `stretch` each, diagonals
/// `shear`; corners along the columns resist with `bend`.
SoftBody makeCloth(const Place& corner, Vec2 along, Vec2 across, int columns, int rows, double mass,
                   double stretch, double shear, double bend = 0);

/// A ring filled with gas, `place` in the middle: the skin has EA = `stretch`, the gas presses with
/// `pressure` and resists compression with `bulk` (SoftBody.h).
SoftBody makeBlob(const Place& centre, double radius, int nodes, double mass, double pressure, double bulk,
                  double stretch, double bend = 0);

/// A beam of `elements` equal ones with bending stiffness `ei` (Young's modulus times second moment of area),
/// tensile stiffness `ea`, and `density` as mass per length. Clamped, its first node is pinned and its
/// direction there held; both ends are free otherwise.
SoftBody makeBeam(const Place& from, Vec2 displacement, int elements, double ei, double ea, double density,
                  bool is_clamped);

}  // namespace naiad::physics
