// Solves all contacts and joints of a group at once if sweeps would converge too slowly: for tall stacks,
// heavy bodies on light ones, and chains.
//
// The unknowns are the velocities. Every row acts like a very stiff spring in addition to its estimated
// impulse (augmented Lagrangian; a semi-smooth Newton method finds which rows push, stick or slip). So
// redundant rows do no harm, and the matrix has three rows per body, for any number of contacts. It is
// factored within its envelope, in Cuthill–McKee order: the cost for a stack or chain grows with its length.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "physics/geometry/Index.h"
#include "physics/rigid/RigidContact.h"

namespace naiad::physics {

struct DirectRow {
  std::int32_t a = -1, b = -1;  ///< local indices of bodies; −1: immovable
  Vec2 n;                       ///< force direction: +n on b, −n on a
  double ja = 0, jb = 0;        ///< factors of the spins, with sign
  double target = 0;            ///< speed along the row that is to be reached
  double softness = 0;          ///< 0: a hard row
  double before = 0;            ///< soft row: impulse at which its spring is slack
  double low = 0, high = std::numeric_limits<double>::infinity();
  std::int32_t normal = -1;  ///< friction row: its normal row; the bounds are ±`friction` times that impulse
  double friction = 0;
  double impulse = 0;   ///< at first the impulse that the velocities already include; then the result
  double expected = 0;  ///< guess of the impulse to be added
};

class RigidDirect {
 public:
  /// Starts a new group with these bodies, without rows.
  void begin(std::span<const int> bodies, std::span<const RigidState> states);
  /// Returns the local index of a body; −1 if it is immovable or not in the group.
  std::int32_t localOf(int body) const;
  std::vector<DirectRow>& rows() { return m_rows; }

  /// Returns the largest speed error of any row at its impulse.
  double worstError() const;
  /// Chooses the order of the bodies. Returns the approximate number of multiplications of a factorisation.
  double order();
  /// Finds impulses and applies them. Returns false and applies none if the tolerance was not reached within
  /// `most_rounds` rounds of factorisation and solution, or a factorisation failed. Sets `rounds` to the
  /// approximate number of rounds.
  bool solve(std::span<RigidState> states, double tolerance, int most_rounds, int& rounds);

 private:
  enum class Side : std::uint8_t { kLow, kFree, kHigh };
  using Two = double __attribute__((vector_size(16)));
  struct Block {
    Two low, high;  ///< three rows; the last number is unused
  };
  struct Velocity {
    double x[3];
  };
  double speedOf(const DirectRow& row) const;
  void setStiffnesses();
  std::int32_t firstOf(const DirectRow& row) const;
  bool setForces(bool is_first);
  bool areFrictionsInBounds(double tolerance) const;
  void computeResidual();
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
  std::vector<std::int32_t> m_local;  // local index, by id of the body; −1: not in the group
  std::vector<DirectRow> m_rows;
  std::vector<Velocity> m_velocity, m_start, m_mass;  // m_mass: 0 if the coordinate cannot change
  std::vector<std::int32_t> m_begin, m_next;          // adjacent bodies, in m_next from m_begin[body] on
  std::vector<std::int32_t> m_rank, m_sequence;
  std::vector<std::int32_t> m_first;   // leftmost column of each row of the matrix
  std::vector<std::int64_t> m_row_at;  // entry (i, j) is at m_row_at[i] + j
  std::vector<double> m_matrix, m_right;
  std::int32_t m_changed = 0;  // rank of the first body whose rows must be factored again
  std::vector<Block> m_block;  // by column, the three rows being factored
  std::vector<double> m_force, m_guess;
  std::vector<Velocity> m_found_velocity;  // the last solution within the tolerance, whose bodies are not
  std::vector<double> m_found_force;       // balanced
  std::vector<Side> m_side;
  double m_largest_mass = 0;
  std::vector<double> m_held_mass;  // by body: effective mass including the springs of its rows
  std::vector<double> m_stiffness;  // stiffness of each row
};

}  // namespace naiad::physics
