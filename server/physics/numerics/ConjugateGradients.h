// Iterative solution of a symmetric positive definite system of 2 × 2 blocks, one block row per node.
//
// Conjugate gradients, preconditioned by the diagonal blocks. An iteration costs a multiplication by the
// matrix, proportional to nodes + pairs, even if the node numbers of pairs are far apart. Used for systems
// that are too wide for a SoftBand. The matrix is stored by diagonals; that of a mesh has only few.
//
// The iteration uses floats, four nodes at a time, plain operators with one rounding each, and sums in a
// fixed order, so that all processors give equal bits. It finds a correction to a few digits; for more digits
// the caller repeats it with the residual in doubles. The minimised function falls in each iteration, so the
// caller may stop early.
#pragma once

#include <span>
#include <vector>

#include "physics/geometry/Index.h"
#include "physics/geometry/Vec2.h"

namespace naiad::physics {

class ConjugateGradients {
 public:
  struct Pair {
    int a;
    int b;
  };
  /// A symmetric block; `xy` is both of its off-diagonal entries.
  struct Block {
    double xx = 0, xy = 0, yy = 0;
  };

  /// Returns the number of diagonals for these pairs: the number of different |a − b|. Each costs as much
  /// memory and time as all nodes.
  static int diagonalsOf(std::span<const Pair> pairs);

  /// Sets the pattern: the diagonal, and blocks (a, b) and (b, a) of these pairs, a != b. Pairs may repeat.
  void resize(int nodes, std::span<const Pair> pairs);
  /// Sets all entries to zero. `scale` > 0 is their rough size, so that they and their inverses fit floats.
  void clear(double scale);
  /// Adds `block` to the blocks (a, b) and (b, a) of this pair.
  void addPair(int pair, const Block& block);
  void addDiagonal(int node, const Block& block) {
    Block& sum = m_diagonal[at(node)];
    sum.xx += block.xx, sum.xy += block.xy, sum.yy += block.yy;
  }
  /// Returns the mean of the two diagonal entries of a node: its stiffness so far.
  double diagonalOf(int node) const { return 0.5 * (m_diagonal[at(node)].xx + m_diagonal[at(node)].yy); }

  /// Replaces `rows` (x and y per node) by the solution, or by the approximation after `most` iterations.
  /// Ends when the error is below `tolerance` times that of zero, or floats have no digits for a better one.
  /// Returns the number of iterations, or −1, with `rows` unchanged, if a diagonal block is not positive
  /// definite or is out of the range of floats, or if an entry of `rows` is 1e150 or more.
  int solve(std::span<double> rows, int most, double tolerance);

 private:
  /// One number per node, with zeros before the first and after the last node for missing neighbours.
  using Numbers = std::vector<float>;
  struct Points {
    Numbers x, y;
  };
  struct Blocks {
    Numbers xx, xy, yy;
  };
  struct Diagonal {
    int distance;
    Blocks blocks;  ///< block i is between the nodes i and i + distance
  };
  struct Slot {
    int diagonal, node;
  };

  void resize(Points& points) const;
  void resize(Blocks& blocks) const;
  bool invertDiagonal();
  void start(std::span<const double> rows, double by);
  double multiply();
  double precondition(float step);
  void turn(float keep);

  int m_nodes = 0;
  int m_margin = 0;  // numbers before that of the first node
  std::vector<Diagonal> m_diagonals;
  std::vector<Slot> m_slots;  // by pair
  std::vector<Block> m_diagonal;
  Blocks m_middle, m_inverse;  // diagonal blocks and their inverses
  Points m_solution, m_residual, m_direction, m_product;
  double m_unit = 1;  // factor that scales entries to about one
};

}  // namespace naiad::physics
