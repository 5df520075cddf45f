#include "physics/flight/IntegratorFixed.h"

#include <algorithm>

namespace naiad::physics {

namespace {

// Steps of the symmetric composition: two forward, one back, together 1.
constexpr double kCubeRoot2 = 1.2599210498948732;
constexpr double kForward = 1 / (2 - kCubeRoot2);
constexpr double kBack = -kCubeRoot2 / (2 - kCubeRoot2);

class FixedSteps {
 public:
  FixedSteps(const ForceField& field, FieldState& state, IntegratorCounters& counters)
      : m_field(field), m_state(state), m_counters(counters) {}

  Vec2 acceleration(Vec2 position, Vec2 velocity, double time) {
    ++m_counters.evaluations;
    return m_field.acceleration(position, velocity, time);
  }

  void begin() { m_acceleration = acceleration(m_state.position, m_state.velocity, m_state.time); }

  void euler(double h) {
    m_state.velocity += h * acceleration(m_state.position, m_state.velocity, m_state.time);
    m_state.position += h * m_state.velocity;
    m_state.time += h;
  }

  void verlet(double h) {
    const Vec2 half = m_state.velocity + 0.5 * h * m_acceleration;
    const Vec2 predicted = m_state.velocity + h * m_acceleration;
    m_state.position += h * half;
    m_state.time += h;
    m_acceleration = acceleration(m_state.position, predicted, m_state.time);
    m_state.velocity = half + 0.5 * h * m_acceleration;
  }

  void rungeKutta(double h) {
    const FieldState s = m_state;
    const Vec2 a1 = acceleration(s.position, s.velocity, s.time);
    const Vec2 v2 = s.velocity + 0.5 * h * a1;
    const Vec2 a2 = acceleration(s.position + 0.5 * h * s.velocity, v2, s.time + 0.5 * h);
    const Vec2 v3 = s.velocity + 0.5 * h * a2;
    const Vec2 a3 = acceleration(s.position + 0.5 * h * v2, v3, s.time + 0.5 * h);
    const Vec2 v4 = s.velocity + h * a3;
    const Vec2 a4 = acceleration(s.position + h * v3, v4, s.time + h);
    m_state.position += h / 6 * (s.velocity + 2 * v2 + 2 * v3 + v4);
    m_state.velocity += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
    m_state.time += h;
  }

 private:
  const ForceField& m_field;
  FieldState& m_state;
  IntegratorCounters& m_counters;
  Vec2 m_acceleration;
};

}  // namespace

void integrateFixed(const ForceField& field, FieldState& state, double t, const IntegratorOptions& options,
                    IntegratorCounters& counters) {
  const int count = std::max(options.substeps, 1);
  const double h = t / count, start = state.time;
  FixedSteps steps(field, state, counters);
  if (options.method == IntegratorMethod::kVelocityVerlet || options.method == IntegratorMethod::kYoshida4) {
    steps.begin();
  }
  for (int i = 0; i < count; ++i) {
    state.time = start + i * h;
    switch (options.method) {
      case IntegratorMethod::kSemiImplicitEuler:
        steps.euler(h);
        break;
      case IntegratorMethod::kYoshida4:
        steps.verlet(kForward * h);
        steps.verlet(kBack * h);
        steps.verlet(kForward * h);
        break;
      case IntegratorMethod::kRungeKutta4:
        steps.rungeKutta(h);
        break;
      default:
        steps.verlet(h);
    }
    ++counters.steps;
  }
}

}  // namespace naiad::physics
