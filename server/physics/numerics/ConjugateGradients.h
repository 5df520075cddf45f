// A symmetric positive definite system of 2 × 2 blocks, one row of them per node, solved by iteration.
//
// Conjugate gradients, preconditioned by the diagonal's blocks. Each iteration costs a multiplication by the
// matrix, that is nodes + pairs, however far apart their numbers are: this is for what is too wide for a
// SoftBand. The matrix is kept by diagonals, which is short and fast for a mesh: its pairs have few different
// distances of numbers.
//
// The iteration runs in floats, four nodes at a time, plain operators, each rounded once, sums in a fixed
// order: the same bits on every processor. It finds a correction to some digits; the caller's residual in
// doubles brings the rest with the next one. The sum that is minimised falls in each iteration, so stopping
// early is safe.
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

  /// How many diagonals pairs take: different |a − b|. Each costs memory and time as all nodes do.
  static int diagonalsOf(std::span<const Pair> pairs);

  /// Blocks (a, b) and (b, a) of these pairs and the diagonal may differ from zero; a != b, and a pair may
  /// come twice.
  void resize(int nodes, std::span<const Pair> pairs);
  /// All zero. `scale` > 0: how large entries are, roughly, so that they and their inverses are floats.
  void clear(double scale);
  /// Both blocks (a, b) and (b, a) of this pair.
  void addPair(int pair, const Block& block);
  void addDiagonal(int node, const Block& block) {
    Block& sum = m_diagonal[at(node)];
    sum.xx += block.xx, sum.xy += block.xy, sum.yy += block.yy;
  }
  /// A node's stiffness so far: the mean of the diagonal's two.
  double diagonalOf(int node) const { return 0.5 * (m_diagonal[at(node)].xx + m_diagonal[at(node)].yy); }

  /// Replaces `rows` (x and y per node) by the solution, or by what `most` iterations find of it. They end
  /// when the error is below `tolerance` of zero's. Returns the iterations, or −1 if the diagonal is not
  /// positive definite.
  int solve(std::span<double> rows, int most, double tolerance);

 private:
  /// One number per node. In front of them and behind them are zeros, for neighbours that there are not.
  using Numbers = std::vector<float>;
  struct Points {
    Numbers x, y;
  };
  struct Blocks {
    Numbers xx, xy, yy;
  };
  struct Diagonal {
    int distance;
    Blocks blocks;  ///< of the nodes i and i + distance: number i
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
  int m_margin = 0;  // numbers in front of the first node's
  std::vector<Diagonal> m_diagonals;
  std::vector<Slot> m_slots;  // by pair
  std::vector<Block> m_diagonal;
  Blocks m_middle, m_inverse;  // the diagonal's blocks, and their inverses
  Points m_solution, m_residual, m_direction, m_product;
  double m_unit = 1;  // entries times this are about one
};

}  // namespace naiad::physics
