// A mass on a spring along a line, as bodies and as an equation.
#pragma once

#include "Systems.h"

namespace lab {

/// Makes a scene with the anchor at 0. The mass starts `system.offset` beyond the rest length.
Scene springScene(const SpringLine& system, int ticks);

/// Returns the offset of the mass from the rest length at time t, by the closed form.
Quad springOffset(const SpringLine& system, Quad t);

}  // namespace lab
