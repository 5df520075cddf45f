// The matrix J·M⁻¹·Jᵀ of an island's constraints, its sparse LDLᵀ factors, and solutions with them.
//
// Rows are eliminated in an order with little fill. A tree of bodies has no fill, so that factoring and
// solving are O(n) (see Baraff, "Linear-time dynamics using Lagrange multipliers", 1996). The closing joint
// of a loop adds the fill of a dense complement, no wider than the loop. Order, pattern and the list of
// updates are computed only when joints change.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "physics/geometry/Vec2.h"

namespace naiad::physics {

/// Jacobian of a scalar constraint: (−n, ja) on body a, (n, jb) on body b.
struct JointRow {
  Vec2 n;
  double ja = 0;
  double jb = 0;
  int a = -1;  ///< −1: no body
  int b = -1;
};

/// Inverse mass and inertia of a body; both 0 if it is immovable.
struct JointMass {
  double inverse_mass = 0;
  double inverse_inertia = 0;
};

/// Returns the elimination order of `rows`. Rows are connected if they share a movable body.
std::vector<int> eliminationOrder(std::span<const JointRow> rows, std::span<const JointMass> masses);

class JointMatrix {
 public:
  /// Sets the pattern. `rows` must be in elimination order, which is also the order of all arrays below.
  void analyse(std::span<const JointRow> rows, std::span<const JointMass> masses);

  /// Factors the matrix, with the diagonal multiplied by 1 + `regularisation`. Returns the number of rows
  /// that depend on other rows; their multipliers will be 0.
  int factor(const JointRow* rows, const JointMass* masses, double regularisation = 0);
  /// Like factor(), without rows with `is_out`, whose right-hand side must be 0, and with `softness` added to
  /// the diagonal.
  int factor(const JointRow* rows, const JointMass* masses, const std::uint8_t* is_out,
             const double* softness, double regularisation);

  /// Replaces the right-hand side by the solution.
  void solve(double* x) const;

  /// True if each row shares a body with the next one, and with no other row.
  bool isChain() const { return m_is_chain; }
  /// True if there are several rows and no entry over kBand rows below the diagonal, as for chains of hinges.
  bool isBand() const { return !m_band.empty(); }
  /// Returns the number of non-zero entries below the diagonal in the factor; entries(): in the matrix.
  int filled() const { return static_cast<int>(m_row.size()); }
  int entries() const { return m_entries; }

 private:
  static constexpr int kBand = 3;

  int factorChain(const JointRow* rows, const JointMass* masses, double regularisation);
  void setLower(const JointRow* rows, const JointMass* masses, const std::uint8_t* is_out);
  int eliminate();
  void solveBand(double* x) const;

  struct Term {  // part of an entry: rows i and k share a body
    int at, i, k, body;
    double sign;
    bool i_is_b, k_is_b;
  };

  int m_size = 0;
  int m_entries = 0;
  bool m_is_chain = false;   // each row shares a body with the next one, and with no other
  std::vector<int> m_begin;  // begin of each column in m_row and m_lower
  std::vector<int> m_row;
  std::vector<int> m_targets;  // entry changed by each update, in factoring order; ~row for a diagonal entry
  std::vector<Term> m_terms;
  std::vector<double> m_lower;
  std::vector<double> m_inverse;  // inverses of the pivots
  std::vector<double> m_pivot;
  std::vector<double> m_band;  // by column, the entries below the diagonal; empty if more than kBand
};

}  // namespace naiad::physics
