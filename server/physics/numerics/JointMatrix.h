// The matrix J·M⁻¹·Jᵀ of the constraints of an island, its sparse LDLᵀ factors, and solving with them.
//
// Rows are eliminated in an order that adds least fill: on a tree of bodies none at all, so that factoring
// and solving are O(n) (Baraff, "Linear-time dynamics using Lagrange multipliers", 1996, says why such an
// order exists); a loop adds the fill of a dense complement for what closes it, no wider than the loop is.
// The order, the pattern and the list of updates are made once, when the joints change.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "physics/geometry/Vec2.h"

namespace naiad::physics {

/// A scalar constraint's Jacobian: (−n, ja) on body a, (n, jb) on body b.
struct JointRow {
  Vec2 n;
  double ja = 0;
  double jb = 0;
  int a = -1;  ///< −1: none
  int b = -1;
};

/// Inverse mass and inertia of a body. Both 0: an immovable one.
struct JointMass {
  double inverse_mass = 0;
  double inverse_inertia = 0;
};

/// The order in which to eliminate rows that touch `bodies[row]` = {a, b}; −1 and immovable bodies connect
/// nothing.
std::vector<int> eliminationOrder(std::span<const JointRow> rows, std::span<const JointMass> masses);

class JointMatrix {
 public:
  /// `rows` are in elimination order, which is the order of all arrays below.
  void analyse(std::span<const JointRow> rows, std::span<const JointMass> masses);

  /// Rows with `is_out` are left out (their solution is 0). `softness` is added to the diagonal; null is
  /// zero. `regularisation` multiplies the diagonal by 1 + itself. Returns the number of rows that depend on
  /// others, whose multipliers will be 0.
  int factor(const JointRow* rows, const JointMass* masses, const std::uint8_t* is_out,
             const double* softness, double regularisation = 0);

  /// From right-hand side to solution, in place.
  void solve(double* x) const;

  /// Does each row share a body with the next one, and with no other?
  bool isChain() const { return m_is_chain; }
  /// Is no entry more than kBand rows below the diagonal? So it is for chains of hinges.
  bool isBand() const { return !m_band.empty(); }
  /// Entries below the diagonal that are not zero in the factor, and in the matrix.
  int filled() const { return static_cast<int>(m_row.size()); }
  int entries() const { return m_entries; }

 private:
  static constexpr int kBand = 3;

  void solveBand(double* x) const;

  struct Term {  // of an entry: rows i and k meet at a body
    int at, i, k, body;
    double sign;
    bool i_is_b, k_is_b;
  };

  int m_size = 0;
  int m_entries = 0;
  bool m_is_chain = false;   // each row shares a body with the next one, and with no other
  std::vector<int> m_begin;  // of each column in m_row and m_lower
  std::vector<int> m_row;
  std::vector<int> m_targets;  // of the updates in the order of factoring; ~row for a diagonal one
  std::vector<Term> m_terms;
  std::vector<double> m_lower;
  std::vector<double> m_inverse;  // of the pivots
  std::vector<double> m_pivot;
  std::vector<double> m_band;  // by column, the entries below the diagonal; empty: some are further below
};

}  // namespace naiad::physics
