// Jointed circles that bounce off each other: handles each impact at its moment, pair by pair.
//
// Between impacts a JointSolver moves the bodies. An impact changes the velocities of two bodies only, with
// their effective masses under their joints; a chain of touching bodies causes a sequence of impacts at one
// moment. So Newton's cradle transfers its momentum to the last ball, where a simultaneous solution would
// distribute it (Chatterjee and Ruina 1998 explain this choice).
//
// This is the time of impact for paths that are bent by joints, which have no formula. The distance of two
// centres is estimated by cubic (Hermite) interpolation of each path; then Newton's method on the JointSolver
// itself finds the moment. ImpactTime.h requires paths that are polynomials, TimeOfImpact.h straight ones.
#pragma once

#include <span>
#include <vector>

#include "physics/joint/JointSolver.h"

namespace naiad::physics {

/// Two circles about their bodies' centres that may touch within a step. Neither body rotates.
struct JointPair {
  int a = -1, b = -1;      ///< a < b
  double reach = 0;        ///< the sum of the radii
  double restitution = 0;  ///< 0 … 1
  double friction = 0;     ///< >= 0
};

struct JointImpact {
  double time = 0;  ///< time since the start of the step
  int pair = -1;
  double impulse = 0;  ///< impulse on b along the normal
};

/// Keeps nothing from step to step, except its memory.
class JointImpacts {
 public:
  /// Steps the bodies of these pairs, and all bodies joined to them, by h. Bodies without joints fly under a
  /// constant force. Returns false and moves nothing if the method is not possible: if bodies press on each
  /// other or overlap, if joints can only pull or only push, if there is a mouse joint or a frozen island, if
  /// immovable bodies move, or if there are too many impacts.
  bool step(JointSolver& solver, std::span<JointBody> bodies, std::span<Joint> joints,
            std::span<const JointPair> pairs, double h);

  /// Restores the bodies to their state before the last successful step.
  void undo(std::span<JointBody> bodies);

  /// Returns the impacts of the last successful step, in order.
  std::span<const JointImpact> impacts() const { return m_impacts; }
  /// Returns the indices of the solver's islands that the last step moved.
  std::span<const int> islands() const { return m_islands; }

 private:
  struct Change {
    Vec2 velocity;
    double spin = 0;
  };

  bool gather(std::span<const JointBody> bodies, std::span<const Joint> joints);
  bool run(std::span<JointBody> bodies, std::span<Joint> joints, double h);
  bool resolveImpacts(std::span<JointBody> bodies, std::span<Joint> joints, double now, int forced);
  void resolveImpact(int pair, std::span<JointBody> bodies, std::span<Joint> joints, double now);
  double inverseEffectiveMass(const JointPair& pair, Vec2 direction, std::span<JointBody> bodies,
                              std::span<Joint> joints);
  void applyImpulse(double impulse, std::span<JointBody> bodies) const;
  int findImpact(std::span<const JointBody> bodies, double left, double& time) const;
  bool refineImpact(int pair, std::span<JointBody> bodies, std::span<Joint> joints, double left,
                    double& time);
  void fly(std::span<JointBody> bodies, std::span<Joint> joints, double h);
  void save(std::span<const JointBody> bodies);
  void restore(std::span<JointBody> bodies) const;

  // State of the current step.
  JointSolver* m_solver = nullptr;
  std::span<const JointPair> m_pairs;
  std::vector<double> m_floor;  // by pair: lower limit of the gap
  std::vector<int> m_islands;   // indices of islands of the solver
  std::vector<int> m_bodies;    // sorted: bodies of these islands, and free bodies
  std::vector<int> m_free;
  std::vector<int> m_joints;
  std::vector<JointBody> m_first, m_before;  // states at the start of the step, and of the present flight
  std::vector<Vec2> m_force;                 // by joint: sums of impulses during the step
  std::vector<double> m_torque;
  std::vector<Change> m_change;   // by index in m_bodies: change of the body's motion by a unit impulse
  std::vector<int> m_responding;  // indices in m_bodies that the unit impulse changes
  std::vector<JointImpact> m_impacts;
};

}  // namespace naiad::physics
