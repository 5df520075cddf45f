// Forces that keep bodies out of one another: a linear complementarity problem with Coulomb friction.
#pragma once

#include <cstdint>
#include <vector>

#include "physics/geometry/Vec2.h"

namespace naiad::physics {

/// One direction of one contact: a push x of `second` along `direction` and of `first` against it.
struct RestRow {
  int first;            ///< index into the masses given to solve(); −1: immovable
  int second;           ///< likewise; at least one is not −1
  Vec2 direction;       ///< unit length, from first to second
  double bias;          ///< what the difference of velocities (or accelerations) along it is without any push
  int normal = -1;      ///< of a friction row: the index of its contact's row, which comes before it
  double friction = 0;  ///< of a friction row: µ
  double slip = 0;      ///< of a friction row: 0 holds within the cone; ±1: slides in that direction already
  double push = 0;      ///< the result; before solve(): a guess, of which only the sign counts
};

/// Finds pushes >= 0 that leave no approach, none where bodies part; friction within µ·push, against the
/// slip. Direct: block principal pivoting (Júdice and Pires 1994) on a sparse Cholesky factorisation of the
/// rows that push; friction cones by fixed-point iteration between the two kinds. Rows that say the same
/// twice share the load. Deterministic; keeps its memory.
class RestSolver {
 public:
  std::vector<RestRow>& rows() { return m_rows; }

  /// False if it did not converge; the pushes then are the best of a bounded number of sweeps. It stops,
  /// without pushes, when it would take more than `most_work` multiplications: see isTooCostly().
  bool solve(const std::vector<double>& inverse_masses, double most_work = 1e300);
  /// Was the last solution given up because of its price?
  bool isTooCostly() const { return m_is_too_costly; }
  /// About how many multiplications the last solution has taken.
  double work() const { return m_work; }

  /// By how much the pushes change the velocity (or acceleration) of a body, after solve().
  Vec2 change(int body) const { return m_change[body]; }
  /// `before` + `change`, one component of them, with 0 for what is only the rounding of all those pushes.
  double settled(int body, double before, double change) const {
    const double after = before + change;
    return after <= kRounding * m_effort[body] && after >= -kRounding * m_effort[body] ? 0 : after;
  }

 private:
  static constexpr double kRounding = 1e-14;  // of the sum of all pushes: some fifty units in the last place
  enum class Side : std::uint8_t { kFree, kLow, kHigh };

  bool solveWithinBounds();
  void updateChange();
  bool solveFree();
  bool factorise();
  bool spend(double work);
  double couple(const RestRow& a, const RestRow& b) const;
  double rateOf(const RestRow& row) const;
  bool setFrictionBounds(int round);
  void sweep();

  std::vector<RestRow> m_rows;
  std::vector<double> m_inverse_masses;
  std::vector<Vec2> m_change;
  std::vector<double> m_effort;  // the sum of all pushes' sizes, over the mass
  std::vector<double> m_low, m_high;
  std::vector<double> m_limit, m_off;  // of friction rows: the cone, and by how much it was wrong
  std::vector<Side> m_side;
  std::vector<int> m_rows_begin, m_rows_of;  // the rows of each body
  std::vector<int> m_free, m_index;          // free rows, and their index among them
  std::vector<int> m_skyline, m_start;       // the first column of each row of the factor, where it is stored
  std::vector<double> m_factor, m_right;
  double m_work = 0, m_most_work = 0;
  bool m_is_too_costly = false;
  double m_bias_scale = 0;
  double m_relaxation = 1;
};

}  // namespace naiad::physics
