// The textbooks' fixed-step methods, as simple as printed, for any System (Equations.h).
#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "Linear.h"
#include "Simulation.h"

namespace lab {

enum class Rule {
  EULER,
  SEMI_IMPLICIT_EULER,
  VERLET,     ///< velocity Verlet with half kicks
  YOSHIDA_4,  ///< three Verlet steps of unequal length, one of them backwards
  RUNGE_KUTTA_4,
  BACKWARD_EULER,
  TR_BDF2,        ///< trapezoidal rule, then a backward difference: order 2, L-stable
  PLANTED_ERROR,  ///< RUNGE_KUTTA_4 with a weight of 1/5 instead of 1/6, an error that must be detected
};

template <class System>
class Integrator : public Simulation {
 public:
  Integrator(System system, Rule rule) : m_system(std::move(system)), m_rule(rule) {
    const auto start = m_system.start();
    std::copy(start.begin(), start.end(), m_y.begin());
  }

  void step(double tick, int substeps) override {
    const double h = tick / substeps;
    for (int i = 0; i < substeps; ++i) {
      advance(h);
      m_t += h;
    }
  }

  BodyState body(int index) const override { return m_system.body(index, m_y.data()); }
  std::span<const double> coordinates() const override { return m_y; }

 private:
  static constexpr std::size_t kN = System::kDimension;
  static constexpr std::size_t kHalf = kN / 2;
  static constexpr int kMaxIterations = 20;
  static constexpr double kConverged = 1e-13;
  using State = std::array<double, kN>;

  void advance(double h) {
    switch (m_rule) {
      case Rule::EULER:
        return add(m_y, h, rate(m_t, m_y));
      case Rule::SEMI_IMPLICIT_EULER:
        return semiImplicit(h);
      case Rule::VERLET:
        return verlet(m_t, h);
      case Rule::YOSHIDA_4:
        return yoshida(h);
      case Rule::RUNGE_KUTTA_4:
        return rungeKutta(h, h / 6);
      case Rule::PLANTED_ERROR:
        return rungeKutta(h, h / 5);
      case Rule::BACKWARD_EULER:
        return solve(m_t + h, h, m_y, m_y);
      case Rule::TR_BDF2:
        return trBdf2(h);
    }
  }

  State rate(double t, const State& y) const {
    State rates;
    m_system.rate(t, y.data(), rates.data());
    return rates;
  }

  static void add(State& y, double factor, const State& rates) {
    for (std::size_t i = 0; i < kN; ++i) y[i] += factor * rates[i];
  }

  void kick(double t, double h) {
    const State rates = rate(t, m_y);
    for (std::size_t i = kHalf; i < kN; ++i) m_y[i] += h * rates[i];
  }
  void drift(double h) {
    for (std::size_t i = 0; i < kHalf; ++i) m_y[i] += h * m_y[kHalf + i];
  }

  void semiImplicit(double h) {
    kick(m_t, h);
    drift(h);
  }
  // Forces that depend on velocities use the velocity after a full kick; otherwise their order would be 1.
  void verlet(double t, double h) {
    State rates = rate(t, m_y);
    State predicted = m_y;
    for (std::size_t i = kHalf; i < kN; ++i) {
      predicted[i] = m_y[i] + h * rates[i];
      m_y[i] += h / 2 * rates[i];
    }
    drift(h);
    std::copy(m_y.begin(), m_y.begin() + kHalf, predicted.begin());
    rates = rate(t + h, predicted);
    for (std::size_t i = kHalf; i < kN; ++i) m_y[i] += h / 2 * rates[i];
  }
  void yoshida(double h) {
    const double root = std::cbrt(2.0);
    const double outer = h / (2 - root);
    const double inner = -root * outer;
    verlet(m_t, outer);
    verlet(m_t + outer, inner);
    verlet(m_t + outer + inner, outer);
  }

  void rungeKutta(double h, double end_weight) {
    const State k1 = rate(m_t, m_y);
    State at = m_y;
    add(at, h / 2, k1);
    const State k2 = rate(m_t + h / 2, at);
    at = m_y;
    add(at, h / 2, k2);
    const State k3 = rate(m_t + h / 2, at);
    at = m_y;
    add(at, h, k3);
    const State k4 = rate(m_t + h, at);
    add(m_y, end_weight, k1);
    add(m_y, h / 3, k2);
    add(m_y, h / 3, k3);
    add(m_y, h / 6, k4);
  }

  void trBdf2(double h) {
    const double gamma = 2 - std::sqrt(2.0);
    const double diagonal = gamma / 2 * h;
    State known = m_y;
    add(known, diagonal, rate(m_t, m_y));
    State middle = m_y;
    solve(m_t + gamma * h, diagonal, known, middle);
    const double weight = 1 / (gamma * (2 - gamma));
    for (std::size_t i = 0; i < kN; ++i) known[i] = weight * middle[i] - (weight - 1) * m_y[i];
    m_y = middle;
    solve(m_t + h, diagonal, known, m_y);
  }

  // Solves y - d f(t, y) = known by Newton's method, starting from y.
  void solve(double t, double d, const State known, State& y) {
    for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
      const State rates = rate(t, y);
      Matrix<double, System::kDimension> matrix = jacobianOf(m_system, t, y.data());
      State correction;
      double size = 0;
      for (std::size_t i = 0; i < kN; ++i) {
        for (double& entry : matrix[i]) entry *= -d;
        matrix[i][i] += 1;
        correction[i] = known[i] + d * rates[i] - y[i];
        size = std::max(size, std::abs(y[i]));
      }
      solveInPlace(matrix, correction);
      double change = 0;
      for (const double value : correction) change = std::max(change, std::abs(value));
      add(y, 1, correction);
      if (change <= kConverged * size) return;
    }
  }

  System m_system;
  Rule m_rule;
  double m_t = 0;
  State m_y{};
};

template <class System>
SimulationPtr makeIntegrator(const System& system, Rule rule) {
  const bool by_halves = rule == Rule::SEMI_IMPLICIT_EULER || rule == Rule::VERLET || rule == Rule::YOSHIDA_4;
  if (by_halves && !System::kSecondOrder) return nullptr;
  return std::make_unique<Integrator<System>>(system, rule);
}

}  // namespace lab
