// The joints of an island as rows: scalar constraints with value, Jacobian, bounds and multiplier, in
// elimination order. A joint has up to three rows.
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

  struct Link {  // a joint, with data for a step; the arms and `bound` change within it
    JointKind kind;
    bool is_plain;     // both anchors are at the bodies' centres
    bool holds_angle;  // holds the angle of b relative to a
    int index;         // index in the caller's joints
    int a, b;          // indices of bodies in JointMotion
    int row[3];        // indices of rows; −1: none
    Vec2 anchor_a, anchor_b;
    Vec2 arm_a, arm_b;  // the anchors at the present rotation
    Vec2 target;
    double length, half_inverse_length;
    double pulled_inverse_mass;  // inverse mass of b, which a mouse joint pulls
    double calm_force;           // largest force for which isCalm() is true in a step of length 1
    double bound;                // the nearer bound of the angle limit
  };

  /// Makes rows for the joints at `joint_indices` of `all_joints`, without values.
  JointConstraints(const JointMotion& motion, std::span<const int> joint_indices,
                   std::span<const Joint> all_joints);

  /// Call before a step; `all_joints` must stay in place until the step's end. Multipliers start from those
  /// of the last step, which are stored in the joints (warm start).
  void load(const JointMotion& motion, std::span<const Joint> all_joints);
  /// Call after a step of `h` with a last stage of `last_h`: stores forces and multipliers in the joints.
  void store(std::span<Joint> all_joints, double h, double last_h) const;

  /// Rotates the anchors with their bodies.
  void setArms(const JointMotion& motion);
  /// Computes the values C of all rows and, if kJacobian is true, their Jacobians.
  template <bool kJacobian>
  void evaluate(const JointMotion& motion);
  /// Sets softness and bounds for a stage of length `h`.
  void prepare(const JointMotion& motion, double h);
  /// Returns the error of a row as a length, or as an angle for rows that hold an angle.
  double residual(int at_row, const JointMotion& motion, double h) const;
  double targetSpeed(int at_row) const;
  /// If `may_clamp`, holds one-sided rows at a bound if their multiplier is beyond it. Releases held rows
  /// whose residual exceeds `tolerance` on the side of the bound, such as a slack rope that has become too
  /// long. Returns true if a row has changed.
  bool changeActiveSet(const JointMotion& motion, double h, bool may_clamp, double tolerance);
  /// Adds impulses, one per row, to the forces of the links.
  void addForces(const std::vector<double>& impulse);

  /// True if a step of h resolves the joints' rotation by their forces. Composed steps have stages longer
  /// than h / substeps, and no advantage if these do not resolve it (a whip, a weight on a light chain).
  bool isCalm(std::span<const Joint> all_joints, double h) const;
  /// Returns how many sub-steps of a step of `h` resolve the oscillation of mouse joints without force limit.
  int substepsOf(std::span<const Joint> all_joints, double h) const;
  /// True if steps may be composed of stages some of which run backwards. False if a row loses energy, or a
  /// spring is too stiff for h.
  bool mayCompose(const JointMotion& motion, std::span<const Joint> all_joints, double h) const;

  std::vector<Link> links;
  std::vector<Vec2> force;  // by link: sums of impulses during the step
  std::vector<double> torque;
  std::vector<Rod> rods;  // by row; used only if all links are rods between centres

  // The index of the following vectors is the row.
  std::vector<JointRow> rows;
  std::vector<Kind> kind;
  std::vector<int> link_of;
  std::vector<double> value;  // C, the position error
  std::vector<double> value_before;
  std::vector<double> multiplier;        // impulse of the first half of a stage
  std::vector<double> softness, memory;  // soft rows: residual = softness·multiplier + C + memory·C before
  std::vector<double> diagonal;          // number that softness adds to the diagonal of the matrix
  std::vector<double> low, high;         // bounds of the multiplier
  std::vector<std::int8_t> side;         // bound at which the multiplier is held: −1 lower, +1 upper
  std::vector<std::uint8_t> is_out;      // true if the row is excluded from the matrix for positions
  std::vector<int> one_sided, soft;      // indices of one-sided and of soft rows
  bool is_smooth = false;                // true if no row is one-sided or soft
  const Joint* joints = nullptr;         // the caller's joints, during a step

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
