// A constraint as a damped spring that is stable at any sub-step length.
//
// The spring is defined by oscillation frequency and damping ratio, independent of the masses (E. Catto,
// "Soft constraints", 2011). It is solved by backward Euler, expressed as the fractions of an error, of a
// mass and of an impulse.
#pragma once

namespace naiad::physics {

/// The fastest oscillation that sub-steps can follow, in oscillations per sub-step.
inline constexpr float kFastestTurns = 0.25f;

struct Softness {
  float rate = 0;           ///< fraction of an error that is undone per unit of time
  float mass_scale = 1;     ///< fraction of a rigid constraint's impulse
  float impulse_scale = 0;  ///< fraction of the previous impulse that is removed
};

/// Returns the softness of a spring with `turns` oscillations in a sub-step of length `h`.
inline Softness softnessOf(float turns, float damping_ratio, float h) {
  constexpr float kTurn = 6.2831853f;
  const float swing = kTurn * turns;
  const float z = 2 * damping_ratio + swing;
  const float y = swing * z;
  const float x = 1 / (1 + y);
  return {swing / h / z, y * x, x};
}

}  // namespace naiad::physics
