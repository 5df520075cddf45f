// Makes the soft bodies of games: rope, cloth, blob, beam.
//
// The result is plain data that may be changed (pins, forces, friction, damping) before it is added to a
// SoftWorld. Invalid numbers make a body that isSound() rejects.
#pragma once

#include "physics/soft/SoftBody.h"

namespace naiad::physics {

/// Makes a rope or chain of equal links over `displacement`, with its place at `from`. The mass is spread
/// evenly: half a link's on each end. `stretch` is EA (a link's stiffness is EA over its length), `bend` is
/// EI; 0 for none.
SoftBody makeRope(const Place& from, Vec2 displacement, int links, double mass, double stretch,
                  double bend = 0);

/// Makes a grid of (columns + 1) × (rows + 1) nodes. Node (i, j) has the number j + i · (rows + 1), so the
/// long side should be the columns'. Threads along and across each have the stiffness `stretch`, diagonals
/// `shear`; corners along the columns resist bending with `bend`.
SoftBody makeCloth(const Place& corner, Vec2 along, Vec2 across, int columns, int rows, double mass,
                   double stretch, double shear, double bend = 0);

/// Makes a ring filled with gas, with `place` at its centre. The skin has EA = `stretch`; the gas presses
/// with `pressure` and resists compression with `bulk` (SoftBody.h).
SoftBody makeBlob(const Place& centre, double radius, int nodes, double mass, double pressure, double bulk,
                  double stretch, double bend = 0);

/// Makes a beam of `elements` equal parts with bending stiffness `ei` (Young's modulus times second moment of
/// area), tensile stiffness `ea`, and mass per length `density`. If clamped, its first node is pinned and its
/// direction there fixed; other ends are free.
SoftBody makeBeam(const Place& from, Vec2 displacement, int elements, double ei, double ea, double density,
                  bool is_clamped);

}  // namespace naiad::physics
