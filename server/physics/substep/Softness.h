// A constraint as a damped spring that a sub-step cannot make unstable.
//
// Given by how fast it may swing and how much it is damped, whatever masses it holds (E. Catto, "Soft
// constraints", 2011): a spring by backward Euler, written as a share of an error to be undone, of a mass and
// of an impulse.
#pragma once

namespace naiad::physics {

/// Of a swing, in a sub-step: as fast as sub-steps can follow.
inline constexpr float kFastestTurns = 0.25f;

struct Softness {
  float rate = 0;           ///< of an error, undone per unit of time
  float mass_scale = 1;     ///< of what a rigid constraint would do
  float impulse_scale = 0;  ///< of the impulse so far, given back
};

/// `turns`: of the swing in a sub-step over `h`.
inline Softness softnessOf(float turns, float damping_ratio, float h) {
  constexpr float kTurn = 6.2831853f;
  const float swing = kTurn * turns;
  const float z = 2 * damping_ratio + swing;
  const float y = swing * z;
  const float x = 1 / (1 + y);
  return {swing / h / z, y * x, x};
}

}  // namespace naiad::physics
