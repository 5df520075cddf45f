// Bodies that joints connect, directly or through others, and how they move through a step.
//
// A stage is RATTLE: half a kick, positions that fulfil the constraints by a simplified Newton iteration with
// the factors of J·M⁻¹·Jᵀ at the start, half a kick, velocities that fulfil them. Springs and other soft rows
// take the trapezoidal rule in the same equations, so that no stiffness limits the step; one-sided rows
// (ropes, limits, motors and mice at their greatest force) are found by an active set. If the iteration does
// not converge, the whole step is repeated with shorter stages; if that does not help, stages are halved, and
// at last a regularised one follows that cannot gain energy (JointFallback.cpp).
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
  /// Indices into the arrays of all bodies and joints. Bodies with inverse mass and inertia 0 may be in many
  /// islands, the others are in one.
  JointIsland(std::span<const int> bodies, std::span<const int> joints, std::span<const JointBody> all_bodies,
              std::span<const Joint> all_joints);

  /// Moves the movable bodies over h > 0 and writes the joints' forces. The arrays are those it was made for.
  void step(std::span<JointBody> bodies, std::span<Joint> joints, double h, Vec2 gravity,
            JointOptions options, JointCounters& counters);

  /// Projects the velocities onto those that the joints allow, and changes nothing else.
  void hold(std::span<JointBody> bodies, std::span<const Joint> joints, JointCounters& counters);

  bool isFrozen() const { return m_is_frozen; }
  /// Do all its joints push and pull, with any force?
  bool isTwoSided() const { return m_constraints.one_sided.empty(); }
  /// Indices of its joints, as they were given.
  void appendJoints(std::vector<int>& joints) const {
    for (const JointConstraints::Link& link : m_constraints.links) joints.push_back(link.index);
  }
  /// Indices of its bodies, as they were given.
  std::span<const int> bodies() const { return m_motion.body; }
  int rows() const { return static_cast<int>(m_constraints.rows.size()); }
  /// Entries that elimination adds: 0 for a tree.
  int fill() const { return m_matrix.filled() - m_matrix.entries(); }

 private:
  // JointIsland.cpp
  bool load(std::span<const JointBody> bodies, std::span<const Joint> joints, Vec2 gravity);
  bool stepBy(JointOptions options, bool is_last, std::span<const JointBody> bodies,
              std::span<const Joint> joints, double h, Vec2 gravity, JointCounters& counters);
  JointChain::Status stepChain(JointOptions options, double h, JointCounters& counters);
  void prepareHold();

  // JointStage.cpp
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

  // JointFallback.cpp
  bool regularisedStage(double h, JointCounters& counters);
  bool projectPlaces(double h, JointCounters& counters);

  JointMotion m_motion;
  JointConstraints m_constraints;
  JointMatrix m_matrix;
  JointChain m_chain;                         // empty, unless it is one
  std::vector<double> m_second;               // by row: impulses of the second half of a stage
  std::vector<double> m_rest;                 // by row: residuals, right-hand sides, increments
  std::vector<std::uint8_t> m_is_out_second;  // by row: is it left out of the matrix for velocities?
  double m_tolerance = 0;                     // of positions, metric cells
  double m_last_h = 0;                        // of the stage that the multipliers are for
  int m_finer = 1;                            // times as many stages as asked for, in the next step
  int m_calm_steps = 0;                       // since m_finer changed
  bool m_is_rod = false;                      // two bodies on one rod: JointRod.h
  bool m_is_frozen = false;
  bool m_is_regularised = false;  // the fall-back has the rest of this step
  bool m_is_factored = false;     // for positions at the present place
};

}  // namespace naiad::physics
