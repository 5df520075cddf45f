// Jointed circles that bounce off one another: from impact to impact, each at its moment, pair by pair.
//
// Between impacts a JointSolver moves them. An impact is that of two bodies alone, with the effective masses
// that their joints leave them; a chain of touching bodies is a sequence of impacts in the same moment. So
// Newton's cradle passes its momentum on, where a simultaneous solution would share it out (Chatterjee and
// Ruina 1998 explain that choice).
//
// Its time-of-impact finder is for paths that no formula describes: a joint bends them. The distance of two
// centres is that of a cubic (Hermite) interpolation of each path, and from there the moment is found by
// Newton's method on the JointSolver itself. ImpactTime.h needs a polynomial, TimeOfImpact.h a straight path.
#pragma once

#include <span>
#include <vector>

#include "physics/joint/JointSolver.h"

namespace naiad::physics {

/// Two circles about their bodies' centres that may touch within a step. Neither body turns.
struct JointPair {
  int a = -1, b = -1;      ///< a < b
  double reach = 0;        ///< the sum of the radii
  double restitution = 0;  ///< 0 … 1
  double friction = 0;     ///< >= 0
};

struct JointImpact {
  double time = 0;  ///< since the start of the step
  int pair = -1;
  double impulse = 0;  ///< along the normal, on b
};

/// Keeps its memory from step to step, and nothing else.
class JointImpacts {
 public:
  /// Steps the bodies of these pairs, with all that is joined to them, over h. Bodies without a joint fly
  /// with a constant force. False, and nothing has moved, where it is not for this method: bodies that press
  /// on one another or overlap, joints that only pull or push, carriers that move.
  bool step(JointSolver& solver, std::span<JointBody> bodies, std::span<Joint> joints,
            std::span<const JointPair> pairs, double h);

  /// Puts the bodies back to where they were before the last step that was done.
  void undo(std::span<JointBody> bodies);

  /// Of the last step that was done, in order.
  std::span<const JointImpact> impacts() const { return m_impacts; }
  /// Indices of the solver's islands that the last step moved.
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

  // Of the current step.
  JointSolver* m_solver = nullptr;
  std::span<const JointPair> m_pairs;
  std::vector<double> m_floor;  // by pair: the gap may not fall below
  std::vector<int> m_islands;   // of the solver
  std::vector<int> m_bodies;    // of all these islands, and free ones; sorted
  std::vector<int> m_free;
  std::vector<int> m_joints;
  std::vector<JointBody> m_first, m_before;  // at the start of the step, and of the flight
  std::vector<Vec2> m_force;                 // by joint: sums of impulses
  std::vector<double> m_torque;
  std::vector<Change> m_change;   // by m_bodies: what a unit impulse does
  std::vector<int> m_responding;  // indices in m_bodies: those that the unit impulse changes
  std::vector<JointImpact> m_impacts;
};

}  // namespace naiad::physics
