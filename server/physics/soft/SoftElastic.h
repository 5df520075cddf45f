// The step of one soft body: an implicit method of order 2 with a direct solution.
//
// Uses BDF2, or backward Euler without history (in the first sub-step, and in contact). The new offsets solve
// M (x − x̂) / β² = F(x), by Newton on the whole body at once. A stretch's curvature uses its predicted
// tension, not k times the inaccurate length of the last iteration, so that rigid links converge like
// constraints. Nodes are ordered so that the matrix is a narrow band; a blob's pressure adds rank one.
//
// The decomposition costs nodes · band². A mesh of stretches alone that would cost more than kMaxDirectPrice
// is *wide*: its systems are solved by a bounded number of conjugate gradient iterations, so that a tick
// costs nodes + springs.
//
// A decomposition that costs more than kKeptPrice is reused in iterations close to the solution while they
// converge.
#pragma once

#include <span>
#include <vector>

#include "physics/geometry/Index.h"
#include "physics/numerics/ConjugateGradients.h"
#include "physics/numerics/SoftBand.h"
#include "physics/soft/SoftBody.h"

namespace naiad::physics {

/// Works on a body stored elsewhere with constant topology. Only prepare() allocates.
class SoftElastic {
 public:
  /// Limit of nodes · band²: just above that of 25 × 25 nodes.
  static constexpr double kMaxDirectPrice = 2e6;
  static constexpr double kKeptPrice = 1e5;  ///< limit of nodes · band²: just below that of 12 × 12 nodes
  /// Limit for a wide body's matrix (ConjugateGradients.h). A cloth has four: along, across, and two oblique.
  static constexpr int kMaxDiagonals = 8;

  /// Prepares a body. Reduces spring stiffness in a wide body that floats cannot tell from rigid.
  void prepare(SoftBody& body);
  bool isWide() const { return m_is_wide; }
  /// Wide bodies only, after prepare().
  void setPinned(int node, bool is_pinned) {
    m_pinned[at(node)] = is_pinned ? 1 : 0;
    m_history = 0;
  }

  /// Starts a sub-step of `h` ticks from the body's state. `is_smooth`: uses a history with an equal h.
  void begin(SoftBody& body, double h, Vec2 gravity, bool is_smooth);
  /// Sets up one iteration's system at the body's present offsets. Returns false if it cannot be solved. A
  /// body without rows (`is_alone`) may reuse the decomposition of an earlier iteration.
  bool assemble(const SoftBody& body, bool is_alone);
  /// True if the last assembly reused an earlier decomposition.
  bool isKept() const { return m_is_kept; }
  /// Changes of the offsets without contacts, by row (rowOf), from the last assembly.
  const std::vector<double>& change() const { return m_change; }
  /// Replaces forces by the resulting changes of the offsets, both by row.
  void respond(double* rows) const;
  /// Wide bodies: adds a contact after assemble(), before solveWide(). It is a push at a node, `force` along
  /// `axis`, that decreases by `stiffness` as the node moves away.
  void addPush(int node, Vec2 axis, double force, double stiffness);
  double stiffnessOf(int node) const { return m_gradients.diagonalOf(node); }
  /// Replaces change(). `is_free`: no external pushes, so momentum is conserved to rounding. Returns false if
  /// it cannot be solved. `is_settled` is set to true if the iteration converged.
  bool solveWide(const SoftBody& body, bool is_free, bool& is_settled);

  /// Moves the body by `change`, and predicts tensions from it. Returns the largest component.
  double apply(SoftBody& body, std::span<const double> change);
  /// Computes the velocities from the offsets.
  void finish(SoftBody& body);
  /// Restores the state at begin().
  void revert(SoftBody& body) const;
  void forgetHistory() { m_history = 0; }
  /// Shifts the offsets' origin.
  void shift(Vec2 by);

  /// Row of a node's x; y is the next one.
  int rowOf(int node) const { return 2 * m_order[at(node)]; }
  int rows() const { return static_cast<int>(m_change.size()); }
  const std::vector<Vec2>& starts() const { return m_start; }
  Vec2 startOf(int node) const { return m_start[at(node)]; }
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
  double m_price = 0;              // cost of a decomposition
  ConjugateGradients m_gradients;  // used instead of m_band for a wide body
  double m_scale = 1;              // size of its entries
  std::vector<double> m_change;
  std::vector<double> m_gas;           // slope of the area, by row
  std::vector<double> m_gas_response;  // response of the body to it
  double m_gas_stiffness = 0;
  double m_gas_scale = 0;
  std::vector<double> m_tensions;  // predicted, by stretch
  std::vector<Vec2> m_directions;  // by stretch, at the last assembly
  std::vector<double> m_elastic;   // forces of the stretches there
  std::vector<double> m_hardness;  // derivatives of these forces by length
  std::vector<Vec2> m_base;        // x̃: velocity = (x − x̃) / β
  std::vector<Vec2> m_inertial;    // x̂
  std::vector<Vec2> m_start, m_start_velocity;
  std::vector<Vec2> m_before, m_before_velocity;  // one sub-step earlier
  Vec2 m_gravity;
  double m_beta = 1;
  double m_h = 0;
  int m_history = 0;
  bool m_is_kept = false;  // the band has an earlier decomposition
  bool m_may_keep = true;  // in this sub-step
  double m_moved = 0;      // in the last iteration
};

}  // namespace naiad::physics
