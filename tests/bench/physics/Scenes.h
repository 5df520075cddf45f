// The scenes of the suite `physics`. docs/bench.md describes them.
#pragma once

#include "Scene.h"

namespace bench::physics {

Scene makePyramid60();
Scene makePyramids100();
Scene makeTumbler500();
Scene makeHeap2000();
Scene makeHeap20000();
Scene makeSmash();
Scene makeChain100();
Scene makeGrid100();

}  // namespace bench::physics
