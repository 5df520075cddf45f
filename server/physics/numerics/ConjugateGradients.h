// A symmetric positive definite system of 2 × 2 blocks, one row of them per node, solved by iteration.
//
// Conjugate gradients, preconditioned by the diagonal's blocks. Each iteration costs a multiplication by the
// matrix, that is nodes + pairs, however the nodes are numbered: this is for what is too wide for a SoftBand.
// The iteration runs in floats, in vectors of four, plain operators, each rounded once: the same bits on
// every processor. It finds a correction to some digits; the caller's residual in doubles brings the rest
// with the next one. The sum that is minimised falls in each iteration, so stopping early is safe.
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
  /// A symmetric block; `xy` stands for both corners.
  struct Block {
    double xx = 0, xy = 0, yy = 0;
  };

  /// Blocks (a, b) and (b, a) of these pairs and the diagonal may differ from zero; a pair may come twice.
  void resize(int nodes, std::span<const Pair> pairs);
  /// All zero. `scale` > 0: how large entries are, roughly, so that they and their inverses are floats.
  void clear(double scale);
  /// The blocks (a, b) and (b, a) of this pair.
  void setPair(int pair, const Block& block);
  void addDiagonal(int node, const Block& block) {
    Block& sum = m_diagonal[at(node)];
    sum.xx += block.xx, sum.xy += block.xy, sum.yy += block.yy;
  }
  /// A node's stiffness so far: the mean of the diagonal's two.
  double diagonalOf(int node) const { return 0.5 * (m_diagonal[at(node)].xx + m_diagonal[at(node)].yy); }

  /// Replaces `rows` (x and y per node) by the solution, or by what `most` iterations find of it. They start
  /// from the last solution, if that is better than zero, and end when the error is below `tolerance` of
  /// zero's. Returns the iterations, or −1 if the diagonal is not positive definite.
  int solve(double* rows, int most, double tolerance);
  /// Starts from zero the next time.
  void forgetSolution() { m_solution_unit = 0; }

 private:
  using Lanes = float __attribute__((vector_size(16)));
  struct Point {
    float x, y;
  };

  bool invertDiagonal();
  void startFromLast(double unit);
  void precondition();
  double multiply();  // m_product = A m_direction; returns their scalar product

  std::vector<int> m_begins;      // by node: its first neighbour
  std::vector<int> m_neighbours;  // by row of blocks
  std::vector<Pair> m_slots;      // by pair: where its two blocks are
  std::vector<Lanes> m_blocks;    // two columns each
  std::vector<Block> m_diagonal;
  std::vector<Lanes> m_middle, m_inverse;  // the diagonal's blocks, and their inverses
  std::vector<Point> m_solution, m_residual, m_direction, m_product, m_preconditioned;
  double m_unit = 1;           // entries times this are about one
  double m_solution_unit = 0;  // of m_solution; 0: there is none
};

}  // namespace naiad::physics
