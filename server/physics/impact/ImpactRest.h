// Solves for the forces that keep bodies apart: a linear complementarity problem with Coulomb friction.
#pragma once

#include <cstdint>
#include <vector>

#include "physics/geometry/Vec2.h"

namespace naiad::physics {

/// One direction of one contact. Its push acts on `second` along `direction`, and on `first` against it.
struct RestRow {
  int first;            ///< index into the masses given to solve(); −1: immovable
  int second;           ///< index like `first`, or −1; at most one of the two is −1
  Vec2 direction;       ///< unit length, from first to second
  double bias;          ///< relative velocity or acceleration, or gap, along `direction` without any push
  int normal = -1;      ///< friction row: index of its contact's normal row, which is before it; else −1
  double friction = 0;  ///< friction row: coefficient of friction
  double slip = 0;  ///< friction row: 0 if it may hold within the cone; ±1 if it slides in this direction
  double push = 0;  ///< the result of solve()
};

/// Finds pushes >= 0 so that no contact approaches, and contacts that separate have no push. Friction is at
/// most µ·push, against the slip. It uses a direct method: block principal pivoting (Júdice and Pires 1994)
/// on a sparse Cholesky factorisation of the active rows, and a fixed-point iteration between normal and
/// friction rows for the cones. Redundant rows share the load. Deterministic; keeps its memory.
class RestSolver {
 public:
  std::vector<RestRow>& rows() { return m_rows; }

  /// Returns false if it did not converge; then the pushes are those after a limited number of sweeps. If it
  /// would need more than `most_work` multiplications, all pushes are 0: see isTooCostly().
  bool solve(const std::vector<double>& inverse_masses, double most_work = 1e300);
  /// True if the last solution was abandoned because of its cost.
  bool isTooCostly() const { return m_is_too_costly; }
  /// Returns the approximate number of multiplications of the last solution.
  double work() const { return m_work; }

  /// Returns the change of a body's velocity (or acceleration) by the pushes, after solve().
  Vec2 change(int body) const { return m_change[body]; }
  /// Returns `before` + `change` for one component, or 0 if the sum is only rounding of the pushes.
  double settled(int body, double before, double change) const {
    const double after = before + change;
    return after <= kRounding * m_effort[body] && after >= -kRounding * m_effort[body] ? 0 : after;
  }

 private:
  static constexpr double kRounding = 1e-14;  // fraction of the pushes' sum: about 50 units in the last place
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
  std::vector<double> m_effort;  // sum of the sizes of all pushes on a body, over its mass
  std::vector<double> m_low, m_high;
  std::vector<double> m_limit, m_off;  // friction rows: limit of the push (the cone), and its last deviation
  std::vector<Side> m_side;
  std::vector<int> m_rows_begin, m_rows_of;  // rows of each body, in m_rows_of from m_rows_begin[body] on
  std::vector<int> m_free, m_index;          // free rows, and their indices by row
  std::vector<int> m_skyline, m_start;  // first column of each row of the factor, and where the row is stored
  std::vector<double> m_factor, m_right;
  double m_work = 0, m_most_work = 0;
  bool m_is_too_costly = false;
  double m_bias_scale = 0;
  double m_relaxation = 1;
};

}  // namespace naiad::physics
