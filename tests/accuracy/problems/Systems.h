// The equations of motion of the problems (Equations.h defines a System).
#pragma once

#include <vector>

#include "Equations.h"
#include "Real.h"

namespace lab {

template <int N>
struct FirstOrder {
  static constexpr int kDimension = N;
  static constexpr bool kSecondOrder = false;
  BodyState body(int, const double*) const { return {}; }  // no scene has bodies with such equations
};

template <int N>
struct SecondOrder {
  static constexpr int kDimension = N;
  static constexpr bool kSecondOrder = true;
};

/// A point in the plane by its coordinates.
struct PlanePoint : SecondOrder<4> {
  BodyState body(int, const double* y) const { return {{y[0], y[1]}, {y[2], y[3]}, 0, 0}; }
};

/// A point in the plane under gravity with linear drag, in N·s/m, and quadratic drag, in N·s²/m², for 1 kg.
struct Flight : PlanePoint {
  Vec velocity;
  double gravity = 0;
  double linear = 0;
  double quadratic = 0;

  std::vector<double> start() const { return {0, 0, velocity.x, velocity.y}; }
  template <class Real>
  void rate(const Real&, const Real* y, Real* rates) const {
    const Real& vx = y[2];
    const Real& vy = y[3];
    rates[0] = vx;
    rates[1] = vy;
    Real drag = Real(linear);
    if (quadratic != 0) drag = drag + Real(quadratic) * sqrt(vx * vx + vy * vy + Real(1e-300));
    rates[2] = -drag * vx;
    rates[3] = -drag * vy - Real(gravity);
  }
};

/// A mass of 1 kg on a spring along a line, which hangs down or lies. y[0] is the mass's distance from
/// `rest`, which is `direction` × rest length from the anchor at 0.
struct SpringLine : SecondOrder<2> {
  double stiffness = 1;
  double damping = 0;
  double gravity = 0;  ///< acceleration along the line, away from the anchor
  double offset = 1;   ///< initial value of y[0]
  Vec direction{1, 0};
  double rest_length = 0;

  std::vector<double> start() const { return {offset, 0}; }
  template <class Real>
  void rate(const Real&, const Real* y, Real* rates) const {
    rates[0] = y[1];
    rates[1] = Real(gravity) - Real(stiffness) * y[0] - Real(damping) * y[1];
  }
  BodyState body(int, const double* y) const {
    return {(rest_length + y[0]) * direction, y[1] * direction, 0, 0};
  }
};

/// A point on a massless rod, by its angle from straight down.
struct Pendulum : SecondOrder<2> {
  double gravity = 10;
  double length = 1;
  double angle = 0;  ///< initial angle

  std::vector<double> start() const { return {angle, 0}; }
  template <class Real>
  void rate(const Real&, const Real* y, Real* rates) const {
    rates[0] = y[1];
    rates[1] = Real(-gravity / length) * sin(y[0]);
  }
  BodyState body(int, const double* y) const {
    const Vec out{std::sin(y[0]), -std::cos(y[0])};
    return {length * out, length * y[1] * Vec{-out.y, out.x}, y[0], y[1]};
  }
};

/// A pendulum in Cartesian coordinates, in which the rod is a stiff spring.
struct StiffPendulum : PlanePoint {
  double gravity = 10;
  double stiffness = 1e6;

  std::vector<double> start() const { return {1, 0, 0, 0}; }
  template <class Real>
  void rate(const Real&, const Real* y, Real* rates) const {
    const Real distance = sqrt(y[0] * y[0] + y[1] * y[1]);
    const Real pull = Real(stiffness) * (distance - Real(1)) / distance;
    rates[0] = y[2];
    rates[1] = y[3];
    rates[2] = -pull * y[0];
    rates[3] = -pull * y[1] - Real(gravity);
  }
};

/// A charge in a uniform magnetic field, given by the cyclotron frequency, and a uniform electric field along
/// x.
struct Charge : PlanePoint {
  double frequency = 100;  ///< rad/s
  double push = 100;       ///< m/s²
  Vec velocity{1, 0};

  std::vector<double> start() const { return {0, 0, velocity.x, velocity.y}; }
  template <class Real>
  void rate(const Real&, const Real* y, Real* rates) const {
    rates[0] = y[2];
    rates[1] = y[3];
    rates[2] = Real(push) + Real(frequency) * y[3];
    rates[3] = Real(-frequency) * y[2];
  }
};

/// The Van der Pol oscillator: x'' = ((1 − x²)x' − x)/ε.
struct VanDerPol : SecondOrder<2> {
  double epsilon = 1e-6;

  std::vector<double> start() const { return {2, 0}; }
  template <class Real>
  void rate(const Real&, const Real* y, Real* rates) const {
    rates[0] = y[1];
    rates[1] = ((Real(1) - y[0] * y[0]) * y[1] - y[0]) / Real(epsilon);
  }
  BodyState body(int, const double* y) const { return {{y[0], 0}, {y[1], 0}, 0, 0}; }
};

/// Robertson's chemical reaction: three species with rates from 0.04 to 3e7.
struct Robertson : FirstOrder<3> {
  std::vector<double> start() const { return {1, 0, 0}; }
  template <class Real>
  void rate(const Real&, const Real* y, Real* rates) const {
    const Real slow = Real(0.04) * y[0];
    const Real back = Real(1e4) * y[1] * y[2];
    const Real fast = Real(3e7) * y[1] * y[1];
    rates[0] = back - slow;
    rates[1] = slow - back - fast;
    rates[2] = fast;
  }
};

/// The "high irradiance response" of a plant, with eight species (Hairer & Wanner, Solving ODEs II, IV.10).
struct Hires : FirstOrder<8> {
  std::vector<double> start() const { return {1, 0, 0, 0, 0, 0, 0, 0.0057}; }
  template <class Real>
  void rate(const Real&, const Real* y, Real* rates) const {
    rates[0] = Real(-1.71) * y[0] + Real(0.43) * y[1] + Real(8.32) * y[2] + Real(0.0007);
    rates[1] = Real(1.71) * y[0] - Real(8.75) * y[1];
    rates[2] = Real(-10.03) * y[2] + Real(0.43) * y[3] + Real(0.035) * y[4];
    rates[3] = Real(8.32) * y[1] + Real(1.71) * y[2] - Real(1.12) * y[3];
    rates[4] = Real(-1.745) * y[4] + Real(0.43) * y[5] + Real(0.43) * y[6];
    rates[5] = Real(-280) * y[5] * y[7] + Real(0.69) * y[3] + Real(1.71) * y[4] - Real(0.43) * y[5] +
               Real(0.69) * y[6];
    rates[6] = Real(280) * y[5] * y[7] - Real(1.81) * y[6];
    rates[7] = -rates[6];
  }
};

/// A planet around a fixed sun at 0. It starts at its point nearest to the sun.
struct Kepler : PlanePoint {
  double mu = 1;            ///< m³/s²
  double eccentricity = 0;  ///< the semi-major axis is 1 m

  std::vector<double> start() const {
    return {1 - eccentricity, 0, 0, std::sqrt(mu * (1 + eccentricity) / (1 - eccentricity))};
  }
  template <class Real>
  void rate(const Real&, const Real* y, Real* rates) const {
    const Real square = y[0] * y[0] + y[1] * y[1];
    const Real pull = Real(mu) / (square * sqrt(square));
    rates[0] = y[2];
    rates[1] = y[3];
    rates[2] = -pull * y[0];
    rates[3] = -pull * y[1];
  }
};

/// Two points of 1 kg on rods of 1 m, by the rods' angles from straight down.
struct DoublePendulum : SecondOrder<4> {
  double gravity = 10;
  double angle = 0;  ///< initial angle of both rods

  std::vector<double> start() const { return {angle, angle, 0, 0}; }
  template <class Real>
  void rate(const Real&, const Real* y, Real* rates) const {
    const Real difference = y[0] - y[1];
    const Real s = sin(difference);
    const Real c = cos(difference);
    const Real g = Real(gravity);
    // Solves M (α, β) = (p, q) for the angular accelerations α and β, with M = [2 c; c 1].
    const Real p = -s * y[3] * y[3] - Real(2) * g * sin(y[0]);
    const Real q = s * y[2] * y[2] - g * sin(y[1]);
    const Real determinant = Real(2) - c * c;
    rates[0] = y[2];
    rates[1] = y[3];
    rates[2] = (p - c * q) / determinant;
    rates[3] = (Real(2) * q - c * p) / determinant;
  }
  BodyState body(int index, const double* y) const {
    const Vec first{std::sin(y[0]), -std::cos(y[0])};
    const Vec first_velocity = y[2] * Vec{std::cos(y[0]), std::sin(y[0])};
    if (index == 0) return {first, first_velocity, y[0], y[2]};
    return {first + Vec{std::sin(y[1]), -std::cos(y[1])},
            first_velocity + y[3] * Vec{std::cos(y[1]), std::sin(y[1])}, y[1], y[3]};
  }
};

}  // namespace lab
