// One soft body's step: an implicit method of order 2 with a direct solution.
//
// BDF2, or backward Euler where there is no history (the first sub-step, and in contact). The new offsets
// solve M (x − x̂) / β² = F(x), by Newton on the whole body at once. A stretch's curvature is taken from its
// predicted tension, not from k times a length that the last iteration has not yet made right: so rigid links
// converge like a constraint. Nodes are ordered so that the matrix is a narrow band; a blob's pressure adds a
// rank of one.
//
// The decomposition costs nodes · band². A mesh of stretches alone for which that is more than
// kMaxDirectPrice is *wide*: its systems are solved by conjugate gradients, a bounded number of iterations,
// so that a tick costs nodes + springs.
//
// A decomposition that costs more than kKeptPrice serves several iterations close to the solution, as long as
// they converge.
#pragma once

#include <span>
#include <vector>

#include "physics/geometry/Index.h"
#include "physics/numerics/ConjugateGradients.h"
#include "physics/numerics/SoftBand.h"
#include "physics/soft/SoftBody.h"

namespace naiad::physics {

/// Works on a body that is kept elsewhere and whose topology does not change after prepare(). Allocates there
/// alone.
class SoftElastic {
 public:
  /// Of nodes · band²: just above that of 25 × 25 nodes.
  static constexpr double kMaxDirectPrice = 2e6;
  static constexpr double kKeptPrice = 1e5;  ///< as that: just below that of 12 × 12 nodes
  /// Of a wide body's matrix (ConjugateGradients.h). A cloth has four: along, across, and two askew.
  static constexpr int kMaxDiagonals = 8;

  /// Springs of a wide body that are stiffer than floats can tell from rigid ones are made less stiff.
  void prepare(SoftBody& body);
  bool isWide() const { return m_is_wide; }
  /// Of a wide body, as after prepare().
  void setPinned(int node, bool is_pinned) {
    m_pinned[at(node)] = is_pinned ? 1 : 0;
    m_history = 0;
  }

  /// Starts a sub-step of `h` ticks from where the body is. `is_smooth`: use the history, if it is of the
  /// same h.
  void begin(SoftBody& body, double h, Vec2 gravity, bool is_smooth);
  /// One iteration's system, at the body's present offsets. False if it cannot be solved. Close to the
  /// solution of a body that is alone, without rows, it has the decomposition of an earlier iteration.
  bool assemble(const SoftBody& body, bool is_alone);
  /// Did the last assembly have an earlier decomposition?
  bool isKept() const { return m_is_kept; }
  /// Of the last assembly: offsets' changes without contact, one per row (rowOf).
  const std::vector<double>& change() const { return m_change; }
  /// Replaces forces by the changes of the offsets that they make, both by row.
  void respond(double* rows) const;
  /// A wide body's iteration: after assemble() contacts are added, and then the system is solved. A contact
  /// is a push at a node, `force` along `axis`, less by `stiffness` as the node gives way.
  void addPush(int node, Vec2 axis, double force, double stiffness);
  double stiffnessOf(int node) const { return m_gradients.diagonalOf(node); }
  /// Replaces change(). `is_free`: nothing outside pushes, so the momentum is to be kept to rounding. False
  /// if it cannot be solved. `is_settled`: the gradients have converged.
  bool solveWide(const SoftBody& body, bool is_free, bool& is_settled);

  /// Moves the body by changes, and predicts tensions from them. Returns the largest component.
  double apply(SoftBody& body, std::span<const double> change);
  /// Velocities that belong to the offsets.
  void finish(SoftBody& body);
  /// Back to where begin() was.
  void revert(SoftBody& body) const;
  void forgetHistory() { m_history = 0; }
  /// Shifts the offsets' origin.
  void shift(Vec2 by);

  /// x is this row, y the next one.
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
  double m_price = 0;              // of a decomposition
  ConjugateGradients m_gradients;  // of a wide body, instead of the band
  double m_scale = 1;              // of its entries
  std::vector<double> m_change;
  std::vector<double> m_gas;           // slope of the area, by row
  std::vector<double> m_gas_response;  // what it does
  double m_gas_stiffness = 0;
  double m_gas_scale = 0;
  std::vector<double> m_tensions;  // of stretches, predicted
  std::vector<Vec2> m_directions;  // of stretches, at the last assembly
  std::vector<double> m_elastic;   // their forces there
  std::vector<double> m_hardness;  // and what those grow by with the length
  std::vector<Vec2> m_base;        // x̃: velocity = (x − x̃) / β
  std::vector<Vec2> m_inertial;    // x̂
  std::vector<Vec2> m_start, m_start_velocity;
  std::vector<Vec2> m_before, m_before_velocity;  // a sub-step earlier
  Vec2 m_gravity;
  double m_beta = 1;
  double m_h = 0;
  int m_history = 0;
  bool m_is_kept = false;  // the band's decomposition
  bool m_may_keep = true;  // in this sub-step
  double m_moved = 0;      // by the last iteration
};

}  // namespace naiad::physics
