// The scenes of the suite `physics`, which docs/bench.md describes. y and gravity point down. All bodies
// start upright, with friction 0.6 and restitution 0. Boxes have full sides in Box2D, too.
#pragma once

#include "tests/accuracy/scene/Scene.h"

namespace lab {

constexpr int kTicksPerLook = 10;
constexpr int kBox2dSteps = 4;  ///< steps of Box2D per tick: 1/120 s each

/// Makes a pyramid with this many rows of boxes, which touch each other, on a floor.
Scene makePyramid(int rows);

Scene makePyramid60();
Scene makePyramids100();
Scene makeTumbler500();
Scene makeHeap2000();
Scene makeHeap20000();
Scene makeSmash();
Scene makeChain100();
Scene makeGrid100();

/// Makes a cloth of side × side nodes with meshes of 1 m, held flat by its two upper corners. Here y points
/// up. For peers it consists of points on rods. `gravity` is in m/s².
Scene makeCloth(int side, double gravity);

}  // namespace lab
