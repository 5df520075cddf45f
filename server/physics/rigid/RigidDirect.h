// A group's contacts and joints solved for at once, where sweeps from one to the next would take too long:
// tall stacks, heavy on light, chains.
//
// The unknowns are the velocities. Every row pulls like a very stiff spring on top of what is known of its
// impulse (augmented Lagrangian; semi-smooth Newton for which rows push, stick or slip), so rows that say the
// same twice do no harm, and the matrix has three rows a body, however many contacts there are. It is
// factored within its envelope, in the order of Cuthill and McKee: a stack or a chain costs its length.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "physics/geometry/Index.h"
#include "physics/rigid/RigidContact.h"

namespace naiad::physics {

struct DirectRow {
  std::int32_t a = -1, b = -1;  ///< local bodies; −1: immovable
  Vec2 n;                       ///< b feels +n, a −n
  double ja = 0, jb = 0;        ///< on the spins, signs included
  double target = 0;            ///< of the speed along it
  double softness = 0;          ///< 0: hard
  double before = 0;            ///< of a soft one: the impulse at which it is slack
  double low = 0, high = std::numeric_limits<double>::infinity();
  std::int32_t normal = -1;  ///< of a friction row: the row that presses; the bounds are ±friction times it
  double friction = 0;
  double impulse = 0;   ///< what the velocities have already had of it; the result
  double expected = 0;  ///< what it may have to exert beside that: a guess
};

class RigidDirect {
 public:
  /// Starts again with these bodies.
  void begin(std::span<const int> bodies, std::span<const RigidState> states);
  /// Local index of a body, −1 if it is immovable or not one of them.
  std::int32_t localOf(int body) const;
  std::vector<DirectRow>& rows() { return m_rows; }

  /// By how much a row's speed is wrong, at worst, given what it exerts.
  double worstError() const;
  /// How many multiplications a factorisation takes, about. Orders the bodies.
  double order();
  /// Finds impulses and applies them. False if they were not found to the tolerance within `most_rounds` of
  /// factorisation and solution; then nothing has changed. `rounds`: how many it took.
  bool solve(std::span<RigidState> states, double tolerance, int most_rounds, int& rounds);

 private:
  enum class Side : std::uint8_t { kLow, kFree, kHigh };
  using Two = double __attribute__((vector_size(16)));
  struct Block {
    Two low, high;  ///< of three rows; the last number is not used
  };
  struct Velocity {
    double x[3];
  };
  double speedOf(const DirectRow& row) const;
  void setStiffnesses();
  std::int32_t firstOf(const DirectRow& row) const;
  bool setForces(bool is_first);
  void setResidual();
  void assemble();
  struct Lever;
  struct Corner;
  static Lever leverA(const DirectRow& row);
  static Lever leverB(const DirectRow& row);
  void addStiffness(std::size_t begin, std::size_t end);
  Lever freeOf(std::int32_t body) const;
  Corner cornerOf(std::int32_t i, std::int32_t j);
  void setCorner(std::int32_t i, std::int32_t j, const Corner& corner);
  bool factor();
  void reduceBlock(std::int64_t first, std::int64_t column);
  bool factorBlock(std::int64_t first, std::int64_t row);
  double* lineOf(std::int64_t row) { return m_matrix.data() + m_row_at[at(row)]; }
  void solveFactored();

  std::vector<int> m_bodies;
  std::vector<std::int32_t> m_local;  // by id; −1: none
  std::vector<DirectRow> m_rows;
  std::vector<Velocity> m_velocity, m_start, m_mass;  // mass 0: that degree of freedom is fixed
  std::vector<std::int32_t> m_begin, m_next;          // adjacency
  std::vector<std::int32_t> m_rank, m_sequence;
  std::vector<std::int32_t> m_first;   // leftmost column of each row of the matrix
  std::vector<std::int64_t> m_row_at;  // so that entry (i, j) is at m_row_at[i] + j
  std::vector<double> m_matrix, m_right;
  std::int32_t m_changed = 0;  // by rank: the first body whose rows are not factored
  std::vector<Block> m_block;  // by column, of the three rows that are being factored
  std::vector<double> m_force, m_guess;
  std::vector<Side> m_side;
  double m_largest_mass = 0;
  std::vector<double> m_held_mass;  // by body: as springs let it feel
  std::vector<double> m_stiffness;  // by row
};

}  // namespace naiad::physics
