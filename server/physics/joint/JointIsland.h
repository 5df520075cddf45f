// Bodies that joints connect, directly or by way of others, and how they move through a step.
//
// A stage is RATTLE: half a kick, positions that fulfil the constraints by a simplified Newton iteration with
// the factors of J·M⁻¹·Jᵀ at the start, half a kick, velocities that fulfil them. Springs and other soft rows
// take the trapezoidal rule in the same equations, so that no stiffness limits the step; one-sided rows
// (ropes, limits, motors and mice at their greatest force) are found by an active set. If the iteration does
// not converge, the whole step is done again with shorter stages; if that does not help, stages are halved,
// and at last a regularised one follows that cannot gain energy.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "physics/joint/Joint.h"
#include "physics/joint/JointChain.h"
#include "physics/joint/JointMethod.h"
#include "physics/numerics/JointMatrix.h"

namespace naiad::physics {

/// What happened, since the counters were made.
struct JointCounters {
  std::uint64_t stages = 0;
  std::uint64_t iterations = 0;   ///< of Newton, all stages together
  std::uint64_t refined = 0;      ///< steps done again with shorter stages, for one had not converged
  std::uint64_t halved = 0;       ///< stages done in two halves, where that did not help
  std::uint64_t regularised = 0;  ///< the fall-back: bounded, not exact
  std::uint64_t dependent = 0;    ///< rows that others imply, each time a matrix was factored
  std::uint64_t unsettled = 0;    ///< active sets that did not come to rest
  std::uint64_t quarantined = 0;  ///< islands frozen because of numbers that nothing can be done with
  std::uint64_t broken = 0;       ///< joints
};

class JointIsland {
 public:
  /// Indices into the arrays of all bodies and joints. Bodies with inverse mass and inertia 0 may be in many
  /// islands, the others are in one.
  JointIsland(std::span<const int> bodies, std::span<const int> joints, std::span<const JointBody> all_bodies,
              std::span<const Joint> all_joints);

  /// Moves the movable bodies over h > 0 and writes the joints' forces. The arrays are those it was made for.
  void step(std::span<JointBody> bodies, std::span<Joint> joints, double h, Vec2 gravity,
            JointOptions options, JointCounters& counters);

  /// Takes out of the velocities what the joints do not allow, and leaves everything else alone.
  void hold(std::span<JointBody> bodies, std::span<const Joint> joints, JointCounters& counters);

  bool isFrozen() const { return m_is_frozen; }
  /// Do all its joints hold both ways, whatever it takes?
  bool isTwoSided() const { return m_one_sided.empty(); }
  /// Indices of its joints, as they were given.
  void appendJoints(std::vector<int>& joints) const {
    for (const Link& link : m_links) joints.push_back(link.index);
  }
  /// Indices of its bodies, as they were given.
  std::span<const int> bodies() const { return m_body; }
  int rows() const { return static_cast<int>(m_rows.size()); }
  /// Entries that elimination adds: 0 for a tree.
  int fill() const { return m_matrix.filled() - m_matrix.entries(); }

 private:
  enum class Kind : std::uint8_t { kHard, kRope, kSoft, kMotor, kLimit };
  using Rod = JointChain::Rod;  // a row of an island that is all rods between centres
  struct Link {                 // a joint, with what does not change within a step
    JointKind kind;
    bool is_plain;  // both anchors at the centres
    int index, a, b;
    int row[3];
    Vec2 anchor_a, anchor_b;
    Vec2 arm_a, arm_b;  // the anchors as turned now
    Vec2 target;
    double length, half_inverse_length;
    double most_force;  // see isCalm
    double bound;       // of the angle limit that is nearer
  };

  bool load(std::span<const JointBody> bodies, std::span<const Joint> joints, Vec2 gravity);
  bool store(std::span<JointBody> bodies, std::span<Joint> joints, double h) const;
  void freeze(std::span<JointBody> bodies, JointCounters& counters);
  bool stepRod(std::span<JointBody> bodies, std::span<Joint> joints, double h, Vec2 gravity,
               JointOptions options, JointCounters& counters) const;
  bool stepBy(JointOptions options, bool is_last, std::span<const JointBody> bodies,
              std::span<const Joint> joints, double h, Vec2 gravity, JointCounters& counters);
  JointChain::Status stepChain(JointOptions options, double h, JointCounters& counters);
  bool isCalm(std::span<const Joint> joints, double h) const;
  double mostCalmForce(const Link& link, const Joint& joint) const;
  bool mayCompose(std::span<const Joint> joints, double h) const;

  bool advance(double h, int depth, JointCounters& counters);
  bool stage(double h, JointCounters& counters);
  bool regularisedStage(double h, JointCounters& counters);
  bool projectPlaces(double h, JointCounters& counters);
  void slowLightOnes();
  bool positions(double h, JointCounters& counters);
  bool newton(double h, JointCounters& counters);
  void velocities(double h, JointCounters& counters);
  void prepareHold();
  void projectVelocities(JointCounters& counters);
  bool changeActiveSet(double h, bool may_clamp);

  template <bool kJacobian>
  void evaluate();
  template <bool kJacobian>
  void evaluateAngle(const Link& link, int row);
  template <bool kJacobian>
  void evaluateLimit(Link& link);
  void setRow(int row, const Link& link, Vec2 n, double ja, double jb);
  void addRows(Link& link, const Joint& joint, bool may_turn);
  void setArms();
  void prepareRows(double h);
  void factor(bool is_for_positions, JointCounters& counters, double regularisation = 0);
  void move(double h);
  void kick(double h);
  void apply(const double* impulse);
  void save();
  void restore();
  double speedAlong(const JointRow& row) const;
  double targetSpeed(int row) const;
  double residual(int row, double h) const;
  double kineticEnergy() const;
  double workSince(const std::vector<Vec2>& places) const;
  void record(const std::vector<double>& impulse);

  std::vector<int> m_body;  // index outside
  std::vector<JointMass> m_mass;
  std::vector<Vec2> m_place, m_velocity, m_place_before, m_velocity_before, m_kicked, m_acceleration;
  std::vector<Rotation> m_rotation, m_rotation_before;
  std::vector<double> m_spin, m_spin_before, m_spin_kicked, m_turn_acceleration;
  bool m_is_turning = false;
  bool m_is_rod = false;
  bool m_is_frozen = false;

  std::vector<Link> m_links;
  std::vector<Rod> m_rods;          // by row; empty if there is any other joint
  const Joint* m_joints = nullptr;  // within a step
  std::vector<JointRow> m_rows;
  JointMatrix m_matrix;
  JointChain m_chain;  // empty, unless it is one
  std::vector<Kind> m_kind;
  std::vector<int> m_link_of;
  std::vector<int> m_one_sided, m_soft;  // rows
  std::vector<double> m_value;           // C
  std::vector<double> m_value_before;
  std::vector<double> m_multiplier, m_second;  // impulses of the first half and of the second
  std::vector<double> m_rest;                  // residuals, right-hand sides, increments
  std::vector<double> m_softness, m_memory;    // of soft rows: s·softness + C + memory·C before
  std::vector<double> m_diagonal;
  std::vector<double> m_low, m_high;
  std::vector<std::int8_t> m_side;     // which bound holds the multiplier: −1 the lower, +1 the upper
  std::vector<std::uint8_t> m_is_out;  // the same as a flag
  std::vector<std::uint8_t> m_is_out_second;
  std::vector<Vec2> m_force;  // per link, sums of impulses
  std::vector<double> m_torque;
  Place m_origin;
  double m_tolerance = 0;
  double m_last_h = 0;
  int m_finer = 1;             // times as many stages as asked for, in the next step
  int m_calm_steps = 0;        // since it changed
  bool m_is_beyond = false;    // the fall-back has the rest of this step
  bool m_is_factored = false;  // for positions at the present place
  bool m_is_smooth = false;    // no row is one-sided or soft
};

}  // namespace naiad::physics
