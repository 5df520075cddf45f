// Makes the kinds of soft bodies for games: rope, cloth, blob, beam.
//
// The result may be changed (pins, forces, friction, damping) before it is added to a SoftWorld. If a number
// is invalid, the result is a body that isValid() rejects.
#pragma once

#include "physics/soft/SoftBody.h"

namespace naiad::physics {

/// Makes a rope or chain of equal links from `from` to `from` + `displacement`, with its place at `from`. The
/// mass is spread evenly, with that of half a link on each end. `stretch` is EA (a link's stiffness is EA
/// over its length), `bend` is EI; 0 for none.
SoftBody makeRope(const Place& from, Vec2 displacement, int links, double mass, double stretch,
                  double bend = 0);

/// Makes a grid of (columns + 1) × (rows + 1) nodes. Node (i, j) has the number j + i · (rows + 1), so there
/// should be at least as many columns as rows. Threads in both directions have the stiffness `stretch`,
/// diagonals have `shear`; corners along the columns resist bending with `bend`.
SoftBody makeCloth(const Place& corner, Vec2 along, Vec2 across, int columns, int rows, double mass,
                   double stretch, double shear, double bend = 0);

/// Makes a ring filled with gas, with `place` at its centre. The skin has EA = `stretch`; the gas presses
/// with `pressure` and resists compression with `bulk` (SoftBody.h).
SoftBody makeBlob(const Place& centre, double radius, int nodes, double mass, double pressure, double bulk,
                  double stretch, double bend = 0);

/// Makes a beam of `elements` equal parts with bending stiffness `ei` (Young's modulus times second moment of
/// area), tensile stiffness `ea`, and mass per length `density`. If `is_clamped`, its first node is pinned
/// and its direction there is fixed; otherwise both ends are free.
SoftBody makeBeam(const Place& from, Vec2 displacement, int elements, double ei, double ea, double density,
                  bool is_clamped);

}  // namespace naiad::physics
