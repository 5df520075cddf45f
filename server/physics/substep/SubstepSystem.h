// The joints of a group solved as one linear system, exactly for any masses, stiffnesses and lengths.
//
// A sweep carries an impulse by one body, so sweeps over a chain of stiff springs overshoot, and a motor
// tears a hinge with a long arm. The system has one row per scalar constraint; springs are backward Euler
// steps. Rows with bounds (motors, limits, ropes) stay at a bound while they push against it. Velocities and
// impulses are doubles, and each body's float state is rounded once per solution.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "physics/geometry/Index.h"
#include "physics/numerics/JointMatrix.h"
#include "physics/substep/SubstepBody.h"

namespace naiad::physics {

class SubstepSystem {
 public:
  struct Row {
    double speed = 0;     ///< speed along the row by the velocities at the start of the step
    double target = 0;    ///< speed that is to be reached
    double bias = 0;      ///< speed that removes the position error; used before the bodies move
    double softness = 0;  ///< inverse mass of the row's spring; 0: a hard row
    double low = -std::numeric_limits<double>::infinity();
    double high = std::numeric_limits<double>::infinity();
    double impulse = 0;      ///< impulse in this sub-step
    bool is_spring = false;  ///< solved only before the bodies move
    bool is_limit = false;   ///< the bias is a gap that may close: used after the bodies moved, too
  };

  /// True if the system was built for these joints and bodies.
  bool isBuiltFor(std::span<const int> key) const;
  /// Builds the pattern. `rows` has the bodies of all rows, as indices of `masses`. `key` identifies both.
  void build(std::span<const int> key, std::span<const JointRow> rows, std::span<const JointMass> masses);
  /// Starts a step; sets the states and inverse masses of the bodies.
  void begin(std::span<const std::int32_t> states, std::span<const JointMass> masses);

  /// Returns a row by its number in build().
  Row& row(int number) { return m_rows[at(m_places[at(number)])]; }
  const Row& row(int number) const { return m_rows[at(m_places[at(number)])]; }
  const JointRow& along(int number) const { return m_along[at(m_places[at(number)])]; }
  void place(int number, Vec2 n, double ja, double jb);

  /// Sets whether gravity acts half before and half after each step (SubstepJoints::findUntouched()).
  void setUntouched(bool is_untouched) { m_is_untouched = is_untouched; }
  bool isUntouched() const { return m_is_untouched; }

  /// True if the factor of any movable body is not 1.
  bool isScaled(std::span<const float> factors) const;

  /// Starts a sub-step: only motors at their maximum torque keep their impulses.
  void beginSubstep(std::span<SubstepState> states);
  /// Solves with springs and biases if `is_soft`, otherwise without.
  void solve(std::span<SubstepState> states, bool is_soft);

 private:
  static constexpr int kMaxRounds = 4;  // limit of the factorisations per solution

  void load(std::span<const SubstepState> states);
  void store(std::span<SubstepState> states) const;
  double errorOf(int i, bool is_soft) const;
  void apply(int i, double impulse);
  bool staysAtBound(int i, bool is_soft) const;
  void factor(bool is_soft);

  std::vector<int> m_key;
  JointMatrix m_matrix;
  std::vector<std::int32_t> m_places;  // index in m_rows, by number
  std::vector<Row> m_rows;             // in the order of elimination, as all arrays by row
  std::vector<JointRow> m_along;
  std::vector<std::uint8_t> m_is_out, m_factored_out;
  std::vector<double> m_softness, m_change;
  std::vector<JointMass> m_masses;  // by local body
  std::vector<std::int32_t> m_states;
  struct Velocity {
    Vec2 linear;
    double spin;
  };
  std::vector<Velocity> m_velocities;
  bool m_is_factored = false, m_has_springs = false, m_was_soft = false, m_is_untouched = false;
};

}  // namespace naiad::physics
