// The joints of an island as rows: scalar constraints with value, Jacobian, bounds and multiplier, in the
// order in which they are eliminated. One joint has up to three rows.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "physics/joint/Joint.h"
#include "physics/joint/JointChain.h"
#include "physics/joint/JointMotion.h"
#include "physics/joint/JointRows.h"
#include "physics/numerics/JointMatrix.h"

namespace naiad::physics {

struct JointConstraints {
  enum class Kind : std::uint8_t { kHard, kRope, kSoft, kMotor, kLimit };
  using Rod = JointChain::Rod;

  struct Link {  // a joint, with what does not change within a step
    JointKind kind;
    bool is_plain;     // both anchors at the centres
    bool holds_angle;  // of b against a
    int index;         // in the caller's joints
    int a, b;          // in JointMotion
    int row[3];        // −1: none
    Vec2 anchor_a, anchor_b;
    Vec2 arm_a, arm_b;  // the anchors as turned now
    Vec2 target;
    double length, half_inverse_length;
    double pulled_inverse_mass;  // of b
    double calm_force;           // the greatest force that is calm in a step of length 1: see isCalm()
    double bound;                // of the angle limit that is nearer
  };

  /// Rows for `joint_indices` (indices into `all_joints`), and no values yet.
  JointConstraints(const JointMotion& motion, std::span<const int> joint_indices,
                   std::span<const Joint> all_joints);

  /// Before a step: `all_joints` stay where they are until its end. Multipliers begin at what the joints
  /// remember of the last step (warm starting).
  void load(const JointMotion& motion, std::span<const Joint> all_joints);
  /// After a step of `h`, whose last stage was `last_h` long: forces, and multipliers to remember.
  void store(std::span<Joint> all_joints, double h, double last_h) const;

  /// Turns the anchors with their bodies.
  void setArms(const JointMotion& motion);
  /// The values C of all rows, and their Jacobians.
  template <bool kJacobian>
  void evaluate(const JointMotion& motion);
  /// Softness and bounds for a stage of `h`.
  void prepare(const JointMotion& motion, double h);
  /// How far a row is from being fulfilled, as a length.
  double residual(int at_row, const JointMotion& motion, double h) const;
  double targetSpeed(int at_row) const;
  /// Holds rows at a bound that their multiplier has left, and releases those that return within `tolerance`.
  /// Has a row changed?
  bool changeActiveSet(const JointMotion& motion, double h, bool may_clamp, double tolerance);
  /// Adds impulses, one per row, to the links' forces.
  void addForces(const std::vector<double>& impulse);

  /// Does h resolve how fast the joints' forces turn them? Composed steps are longer than h / substeps, and
  /// gain nothing where they resolve nothing (a whip, a heavy weight on a light chain).
  bool isCalm(std::span<const Joint> all_joints, double h) const;
  /// How many sub-steps of a step of `h` it takes to follow the swing of unlimited mice.
  int substepsOf(std::span<const Joint> all_joints, double h) const;
  /// May steps be composed of stages of which some run backwards? Not if a row loses energy.
  bool mayCompose(const JointMotion& motion, std::span<const Joint> all_joints, double h) const;

  std::vector<Link> links;
  std::vector<Vec2> force;  // by link: sums of impulses
  std::vector<double> torque;
  std::vector<Rod> rods;  // by row; empty unless all links are rods between centres

  // By row.
  std::vector<JointRow> rows;
  std::vector<Kind> kind;
  std::vector<int> link_of;
  std::vector<double> value;  // C
  std::vector<double> value_before;
  std::vector<double> multiplier;        // impulse of the first half of a stage
  std::vector<double> softness, memory;  // of soft rows: multiplier·softness + C + memory·C before
  std::vector<double> diagonal;          // what softness adds to the matrix
  std::vector<double> low, high;         // bounds of the multiplier
  std::vector<std::int8_t> side;         // the bound that holds the multiplier: −1 the lower, +1 the upper
  std::vector<std::uint8_t> is_out;      // is the row left out of the matrix for positions?
  std::vector<int> one_sided, soft;      // lists of rows
  bool is_smooth = false;                // no row is one-sided or soft
  const Joint* joints = nullptr;         // the caller's, within a step

 private:
  const Joint& jointOf(int at_row) const;
  double inverseEffectiveMass(const JointMotion& motion, int at_row) const;
  template <bool kJacobian>
  void evaluateRod(int at_row, const Link& link, Vec2 apart);
  template <bool kJacobian>
  void chooseBound(int at_row, Link& link, const SpeedRow& placed);
  void addRows(Link& link, const Joint& joint, bool may_turn);
  void sortByElimination(const JointMotion& motion);
  void assignRows(std::span<const Joint> all_joints);
};

}  // namespace naiad::physics
