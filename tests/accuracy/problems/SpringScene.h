// A mass on a spring along a line, as bodies and as an equation.
#pragma once

#include "Systems.h"

namespace lab {

/// The anchor is at 0; the mass starts `system.offset` beyond the rest length.
Scene springScene(const SpringLine& system, int ticks);

/// Where the mass is at time t, from the rest length on, by the closed form of the damped oscillator.
Quad springOffset(const SpringLine& system, Quad t);

}  // namespace lab
