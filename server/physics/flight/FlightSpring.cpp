#include "physics/flight/FlightSpring.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "shared/math/DoubleDouble.h"
#include "shared/math/Elementary.h"

namespace naiad::physics {

namespace math = df::math;

SpringFlow::SpringFlow(Spring spring, double t) : m_stiffness(spring.stiffness) {
  assert(spring.stiffness >= 0 && spring.damping >= 0 && t >= 0);
  const double half = 0.5 * spring.damping;
  if (std::max(spring.stiffness * t * t, half * half * t * t) <= 0.25) {
    series(spring.damping, t);
  } else if (half * half >= spring.stiffness) {
    overdamped(spring.damping, t);
  } else {
    underdamped(spring.damping, t);
  }
}

namespace {

constexpr int kShortTerms = 24;  // terms of the series for short steps; the next one is below rounding
constexpr int kDragTerms = 20;   // number of terms needed without stiffness

constexpr std::array<double, kShortTerms + 2> kInverse = [] {
  std::array<double, kShortTerms + 2> inverse{};
  for (int n = 1; n < kShortTerms + 2; ++n) inverse[n] = 1.0 / n;
  return inverse;
}();

}  // namespace

// Short steps: uses a Taylor series without cancellation, for any small stiffness and damping.
void SpringFlow::series(double damping, double t) {
  const double z = damping * t, w = m_stiffness * t * t;
  double before = 0, term = 1;  // terms n − 1 and n of the displacement divided by t
  double left = 1, displacement = 1, integral = 0.5;
  if (w == 0) {  // only drag: nested multiplications by z
    for (int n = kDragTerms; n > 2; --n) term = 1 - z * kInverse[static_cast<std::size_t>(n)] * term;
    integral *= term;
    displacement = 1 - z * integral;
    left = 1 - z * displacement;
  }
  for (int n = 1; n < kShortTerms && w != 0; ++n) {
    const double next = -(z * term + w * kInverse[n] * before) * kInverse[n + 1];
    before = term;
    term = next;
    left += (n + 1) * term;
    displacement += term;
    integral += term * kInverse[n + 2];
    if (std::fabs(term) + std::fabs(before) < 1e-18) break;
  }
  m_velocity_response = left;
  m_displacement_response = t * displacement;
  m_integral_response = t * t * integral;
}

// The sum of two decays. The slower rate is computed from the product of both rates, not from a difference.
void SpringFlow::overdamped(double damping, double t) {
  const double half = 0.5 * damping, root = std::sqrt(m_stiffness);
  const double split = root > 0 ? std::sqrt((half - root) * (half + root)) : half;  // only drag, if root is 0
  const double fast = half + split, slow = m_stiffness / fast;
  const double decay_slow = math::exp(-slow * t), decay_fast = math::exp(-fast * t);
  const double width = 2 * split;
  m_displacement_response = decay_slow * (width * t > 0x1p-500 ? -math::expm1(-width * t) / width : t);
  m_velocity_response = decay_fast - slow * m_displacement_response;
  if (fast > 2 * slow) {
    const double displacement_slow = slow * t > 0x1p-500 ? -math::expm1(-slow * t) / slow : t;
    m_integral_response = (displacement_slow + math::expm1(-fast * t) / fast) / width;
  } else {
    m_integral_response = (1 - (decay_slow + slow * m_displacement_response)) / m_stiffness;
  }
}

void SpringFlow::underdamped(double damping, double t) {
  const double half = 0.5 * damping;
  const math::DoubleDouble frequency = math::squareRoot(-math::twoProduct(half, half) + m_stiffness);
  const math::DoubleDouble phase = frequency * t;
  // The phase may be thousands of turns. A single double is too coarse for that, so its low part is included.
  const math::SineCosine circle = math::sincos(phase.hi);
  math::SineCosine rest = {phase.lo, 1};
  if (std::fabs(phase.lo) > 0x1p-27) rest = math::sincos(phase.lo);
  const double sine = circle.sine * rest.cosine + circle.cosine * rest.sine;
  const double cosine = circle.cosine * rest.cosine - circle.sine * rest.sine;
  const double decay = math::exp(-half * t);
  const double swing = phase.hi > 0x1p-500 ? sine / frequency.hi : t;
  m_displacement_response = decay * swing;
  m_velocity_response = decay * (cosine - half * swing);
  m_integral_response = (1 - decay * (cosine + half * swing)) / m_stiffness;
}

}  // namespace naiad::physics
