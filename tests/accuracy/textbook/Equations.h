// A scene's motion as an ordinary differential equation y' = f(t, y), for the textbooks' methods and for the
// references.
//
// A System is a struct with
//   static constexpr int kDimension;       number of coordinates
//   static constexpr bool kSecondOrder;    true: first half positions, second half their rates, in that order
//   template <class Real> void rate(const Real& t, const Real* y, Real* rates) const;   double, Quad, Dual
//   std::vector<double> start() const;     y at t = 0
//   BodyState body(int index, const double* y) const;    state of the scene's body
#pragma once

#include <memory>
#include <vector>

#include "Cvode.h"
#include "Extrapolation.h"
#include "Integrators.h"
#include "Scene.h"
#include "Simulation.h"

namespace lab {

/// States at the end of each tick, from tick 0 on.
using Trajectory = std::vector<std::vector<double>>;

class Equations {
 public:
  virtual ~Equations() = default;
  /// Returns the state of the scene's body with this index, given the coordinates.
  virtual BodyState body(int index, const double* y) const = 0;
  /// Returns the coordinates at t = 0.
  virtual std::vector<double> start() const = 0;
  /// Returns functions for rates and Jacobian in double precision, valid as long as this object.
  virtual OdeFunctions functions() const = 0;
  /// Returns a simulation that integrates by this rule; null if the rule does not apply to these equations.
  virtual SimulationPtr integrate(Rule rule) const = 0;
  /// Solves by CVODE with BDF or Adams, with a relative tolerance of at most 1e-12. Throws std::runtime_error
  /// on failure.
  virtual Trajectory byCvode(double tick, int ticks, const CvodeOptions& options) const = 0;
  /// Solves by extrapolation in quad precision, which shares only the equations with CVODE.
  virtual Trajectory byExtrapolation(double tick, int ticks, Stiffness stiffness) const = 0;
};

template <class System>
class EquationsOf : public Equations {
 public:
  explicit EquationsOf(System system) : m_system(std::move(system)) {}

  BodyState body(int index, const double* y) const override { return m_system.body(index, y); }

  SimulationPtr integrate(Rule rule) const override { return makeIntegrator(m_system, rule); }

  std::vector<double> start() const override { return m_system.start(); }

  OdeFunctions functions() const override {
    OdeFunctions functions;
    functions.dimension = System::kDimension;
    functions.rate = [this](double t, const double* y, double* rates) { m_system.rate(t, y, rates); };
    functions.jacobian = [this](double t, const double* y, double* columns) {
      const auto jacobian = jacobianOf(m_system, t, y);
      for (int row = 0; row < System::kDimension; ++row) {
        for (int column = 0; column < System::kDimension; ++column) {
          columns[column * System::kDimension + row] = jacobian[row][column];
        }
      }
    };
    return functions;
  }

  Trajectory byCvode(double tick, int ticks, const CvodeOptions& options) const override {
    return solveByCvode(functions(), start(), tick, ticks, options);
  }

  Trajectory byExtrapolation(double tick, int ticks, Stiffness stiffness) const override {
    return solveByExtrapolation(m_system, tick, ticks, stiffness);
  }

 private:
  System m_system;
};

template <class System>
std::shared_ptr<const Equations> equationsOf(System system) {
  return std::make_shared<EquationsOf<System>>(std::move(system));
}

}  // namespace lab
