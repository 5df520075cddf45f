// The step of one soft body: an implicit method of order 2 with a direct solution.
//
// Uses BDF2, or backward Euler if there is no history (in the first sub-step, and in contact). The new
// offsets solve M (x − x̂) / β² = F(x), by Newton's method on the whole body. A stretch's curvature uses its
// predicted tension, not k times the inaccurate length of the last iteration, so that rigid links converge
// like constraints. Nodes are ordered so that the matrix is a narrow band; a blob's pressure adds rank one.
//
// The decomposition costs nodes · band² multiplications. A mesh that has only stretches and would cost more
// than kMaxDirectPrice is *wide*: its systems are solved by a bounded number of conjugate gradient
// iterations, so that the cost of a tick is proportional to nodes + springs.
//
// A decomposition that costs over kKeptPrice is reused in iterations near the solution, while they converge.
#pragma once

#include <span>
#include <vector>

#include "physics/geometry/Index.h"
#include "physics/numerics/ConjugateGradients.h"
#include "physics/numerics/SoftBand.h"
#include "physics/soft/SoftBody.h"

namespace naiad::physics {

/// The step of a body stored elsewhere, whose topology must stay constant. Only prepare() allocates.
class SoftElastic {
 public:
  /// Limit of nodes · band² for bodies that are not wide: just below that of 20 × 20 nodes, where a wide body
  /// costs half as much.
  static constexpr double kMaxDirectPrice = 7e5;
  /// Nodes · band² above which decompositions are used again: just below that of 12 × 12 nodes.
  static constexpr double kKeptPrice = 1e5;
  /// Limit of diagonals of a wide body's matrix. A cloth has four: along, across, and two oblique.
  static constexpr int kMaxDiagonals = 8;

  /// Prepares a body. In a wide body, reduces the stiffness of springs that is too high for floats.
  void prepare(SoftBody& body);
  bool isWide() const { return m_is_wide; }
  /// Pins or releases a node. Only for wide bodies, after prepare().
  void setPinned(int node, bool is_pinned) {
    m_pinned[at(node)] = is_pinned ? 1 : 0;
    m_history = 0;
  }

  /// Starts a sub-step of `h` ticks from the body's state. `is_smooth`: uses the history if its h is equal.
  void begin(SoftBody& body, double h, Vec2 gravity, bool is_smooth);
  /// Sets up one iteration's system at the body's present offsets. Returns false if it cannot be solved. For
  /// a body without rows (`is_alone`), the decomposition of an earlier iteration may be used.
  bool assemble(const SoftBody& body, bool is_alone);
  /// True if the last assemble() used an earlier decomposition again.
  bool isKept() const { return m_is_kept; }
  /// Returns the changes of the offsets, by row (rowOf): without contacts, from the last assemble(); for wide
  /// bodies with contacts, from solveWide().
  const std::vector<double>& change() const { return m_change; }
  /// Replaces forces by the resulting changes of the offsets, both by row.
  void respond(double* rows) const;
  /// Wide bodies only: adds a contact after assemble(), before solveWide(). It is a push at a node along
  /// `axis`, of size `force`, that decreases by `stiffness` as the node moves away.
  void addPush(int node, Vec2 axis, double force, double stiffness);
  double stiffnessOf(int node) const { return m_gradients.diagonalOf(node); }
  /// Wide bodies only: computes change(). `is_free`: no external pushes, so momentum is conserved to
  /// rounding. Returns false if it cannot be solved. Sets `is_settled` to true if the iteration converged.
  bool solveWide(const SoftBody& body, bool is_free, bool& is_settled);

  /// Moves the body by `change`, and predicts tensions from it. Returns the largest component of `change`.
  double apply(SoftBody& body, std::span<const double> change);
  /// Computes the velocities from the offsets.
  void finish(SoftBody& body);
  /// Restores the body's state at begin().
  void revert(SoftBody& body) const;
  void forgetHistory() { m_history = 0; }
  /// Moves the origin of the offsets.
  void shift(Vec2 by);

  /// Returns the row of a node's x; the row of y is the next one.
  int rowOf(int node) const { return 2 * m_order[at(node)]; }
  int rows() const { return static_cast<int>(m_change.size()); }
  const std::vector<Vec2>& starts() const { return m_start; }
  Vec2 startOf(int node) const { return m_start[at(node)]; }
  /// Returns β, the time for which a node's velocity is (x − x̃) / β: h, or 2h/3 with history.
  double beta() const { return m_beta; }

 private:
  void addMass(const SoftBody& body);
  void addStretches(const SoftBody& body);
  void addBends(const SoftBody& body);
  void addPressure(const SoftBody& body);
  void addSpring(const int* nodes, const Vec2* slopes, int count, double force, double stiffness);
  void prepareWide(SoftBody& body);
  void addLink(const SoftStretch& s, int pair, Vec2 along, double force, double stiffness, double taut);
  void addEntry(int i, int j, double xx, double xy, double yx, double yy);
  Vec2 rateOf(const SoftBody& body, int node) const {
    return (body.nodes[at(node)].offset - m_base[at(node)]) / m_beta;
  }

  std::vector<int> m_order;
  std::vector<char> m_pinned;
  SoftBand m_band;
  bool m_is_wide = false;
  double m_price = 0;              // cost of a decomposition, nodes · band²
  ConjugateGradients m_gradients;  // used instead of m_band for a wide body
  double m_scale = 1;              // size of the matrix's entries
  std::vector<double> m_change;
  std::vector<double> m_gas;           // derivative of the area, by row
  std::vector<double> m_gas_response;  // response of the body to the forces m_gas
  double m_gas_stiffness = 0;
  double m_gas_scale = 0;
  std::vector<double> m_tensions;  // predicted tensions, by stretch
  std::vector<Vec2> m_directions;  // directions of the stretches at the last assemble()
  std::vector<double> m_elastic;   // forces of the stretches at the last assemble()
  std::vector<double> m_hardness;  // derivatives of the forces m_elastic with respect to length
  std::vector<Vec2> m_base;        // x̃: velocity = (x − x̃) / β
  std::vector<Vec2> m_inertial;    // x̂ of the equation at the top
  std::vector<Vec2> m_start, m_start_velocity;
  std::vector<Vec2> m_before, m_before_velocity;  // state one sub-step earlier
  Vec2 m_gravity;
  double m_beta = 1;
  double m_h = 0;
  int m_history = 0;
  bool m_is_kept = false;  // the band has the decomposition of an earlier iteration
  bool m_may_keep = true;  // true if decompositions may be used again in this sub-step
  double m_moved = 0;      // largest movement in the last iteration
};

}  // namespace naiad::physics
