// Bodies connected by joints, directly or through others, and their motion in a step.
//
// A stage is RATTLE: half a kick; positions that fulfil the constraints, by simplified Newton iteration with
// the factors of J·M⁻¹·Jᵀ at the start; half a kick; velocities that fulfil the constraints. Springs and
// other soft rows use the trapezoidal rule in these equations, so that stiffness does not limit the step. An
// active set finds which one-sided rows (ropes, limits, motors and mice at maximum force) act. If the
// iteration does not converge, the whole step is repeated with shorter stages; if that does not help, stages
// are halved. The last resort is a regularised stage that cannot gain energy.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "physics/joint/Joint.h"
#include "physics/joint/JointChain.h"
#include "physics/joint/JointConstraints.h"
#include "physics/joint/JointMethod.h"
#include "physics/joint/JointMotion.h"
#include "physics/numerics/JointMatrix.h"

namespace naiad::physics {

class JointIsland {
 public:
  /// `bodies` and `joints` are indices into `all_bodies` and `all_joints`. Bodies with inverse mass and
  /// inertia 0 may be in many islands, all other bodies in only one.
  JointIsland(std::span<const int> bodies, std::span<const int> joints, std::span<const JointBody> all_bodies,
              std::span<const Joint> all_joints);

  /// Moves the movable bodies over h > 0, and writes the joints' forces. The arrays are those of the
  /// constructor. If numbers are out of range, stops the bodies and freezes the island.
  void step(std::span<JointBody> bodies, std::span<Joint> joints, double h, Vec2 gravity,
            JointOptions options, JointCounters& counters);

  /// Projects the velocities onto those that the joints allow; changes nothing else.
  void hold(std::span<JointBody> bodies, std::span<const Joint> joints, JointCounters& counters);

  bool isFrozen() const { return m_is_frozen; }
  /// True if all its joints can both push and pull with unlimited force.
  bool isTwoSided() const { return m_constraints.one_sided.empty(); }
  /// Appends the indices of the island's joints in the caller's array.
  void appendJoints(std::vector<int>& joints) const {
    for (const JointConstraints::Link& link : m_constraints.links) joints.push_back(link.index);
  }
  /// Returns the indices of the island's bodies in the caller's array.
  std::span<const int> bodies() const { return m_motion.body; }
  int rows() const { return static_cast<int>(m_constraints.rows.size()); }
  /// Returns the number of matrix entries that elimination adds: 0 for a tree.
  int fill() const { return m_matrix.filled() - m_matrix.entries(); }

 private:
  // Defined in JointIsland.cpp:
  bool load(std::span<const JointBody> bodies, std::span<const Joint> joints, Vec2 gravity);
  bool stepBy(JointOptions options, bool is_last, std::span<const JointBody> bodies,
              std::span<const Joint> joints, double h, Vec2 gravity, JointCounters& counters);
  JointChain::Status stepChain(JointOptions options, double h, JointCounters& counters);
  void prepareHold();

  // Defined in JointStage.cpp:
  bool advance(double h, int depth, JointCounters& counters);
  bool stage(double h, JointCounters& counters);
  bool solvePositions(double h, JointCounters& counters);
  bool iterateNewton(double h, JointCounters& counters);
  void finishVelocities(double h, JointCounters& counters);
  void projectVelocities(JointCounters& counters);
  void factor(bool is_for_positions, JointCounters& counters, double regularisation = 0);
  void move(double h);
  void applyImpulses(const std::vector<double>& impulse);
  void restore();

  // Defined in JointStage.cpp, the last resort:
  bool regularisedStage(double h, JointCounters& counters);
  bool projectPlaces(double h, JointCounters& counters);

  JointMotion m_motion;
  JointConstraints m_constraints;
  JointMatrix m_matrix;
  JointChain m_chain;                         // empty if the island is not a chain
  std::vector<double> m_second;               // by row: impulses of the second half of a stage
  std::vector<double> m_rest;                 // by row: residuals, right-hand sides, increments
  std::vector<std::uint8_t> m_is_out_second;  // by row: true if excluded from the matrix for velocities
  double m_tolerance = 0;                     // tolerance of positions, in metric cells
  double m_last_h = 0;                        // length of the stage to which the multipliers belong
  int m_finer = 1;                            // factor for the number of stages in the next step
  int m_calm_steps = 0;                       // steps since m_finer changed
  bool m_is_rod = false;                      // two bodies on one rod: JointRod.h
  bool m_is_frozen = false;
  bool m_is_regularised = false;  // this step continues with regularised stages
  bool m_is_factored = false;     // the matrix for positions is factored at the present place
};

}  // namespace naiad::physics
