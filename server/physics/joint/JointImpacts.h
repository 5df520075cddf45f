// Jointed circles that bounce off one another: from impact to impact, each at its moment, pair by pair.
//
// Between impacts a JointSolver moves them. An impact is that of two bodies alone, with the masses that their
// joints leave them; what touches further on is struck by the next one, in the same moment: so Newton's
// cradle hands on its momentum, where all at once would share it out (Chatterjee and Ruina 1998 say why
// that is a choice, and which).
#pragma once

#include <span>
#include <vector>

#include "physics/joint/JointSolver.h"

namespace naiad::physics {

/// Two circles about their bodies' centres that may meet within a step. Neither body turns.
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
  /// Moves the bodies of these pairs, with all that is joined to them, over h. Bodies without a joint fly
  /// with a constant force. False, and nothing has moved, where it is not for this method: bodies that press
  /// on one another or overlap, joints that only pull or push, carriers that move.
  bool step(JointSolver& solver, std::span<JointBody> bodies, std::span<Joint> joints,
            std::span<const JointPair> pairs, double h);

  /// The bodies are where they were before the last step, which was done.
  void undo(std::span<JointBody> bodies);

  /// Of the last step that was done, in order.
  std::span<const JointImpact> impacts() const { return m_impacts; }
  /// Of the solver, the islands that it has moved.
  std::span<const int> islands() const { return m_islands; }

 private:
  struct Change {
    Vec2 velocity;
    double spin = 0;
  };

  bool gather(std::span<const JointBody> bodies, std::span<const Joint> joints);
  bool run(std::span<JointBody> bodies, std::span<Joint> joints, double h);
  bool strikeAll(std::span<JointBody> bodies, std::span<Joint> joints, double now, int forced);
  void strike(int pair, std::span<JointBody> bodies, std::span<Joint> joints, double now);
  double answer(const JointPair& pair, Vec2 direction, std::span<JointBody> bodies, std::span<Joint> joints);
  void apply(double impulse, std::span<JointBody> bodies) const;
  int findMeeting(std::span<const JointBody> bodies, double left, double& time) const;
  bool approachMeeting(int pair, std::span<JointBody> bodies, std::span<Joint> joints, double left,
                       double& time);
  void fly(std::span<JointBody> bodies, std::span<Joint> joints, double h);
  void save(std::span<const JointBody> bodies);
  void restore(std::span<JointBody> bodies) const;

  // Of the step at hand.
  JointSolver* m_solver = nullptr;
  std::span<const JointPair> m_pairs;
  std::vector<double> m_floor;  // by pair: the gap may not fall below
  std::vector<int> m_islands;   // of the solver
  std::vector<int> m_bodies;    // of all these islands, and free ones; sorted
  std::vector<int> m_free;
  std::vector<int> m_joints;
  std::vector<JointBody> m_first, m_before;  // at the start of the step, and of the flight
  std::vector<Vec2> m_force;                 // by joint: impulses so far
  std::vector<double> m_torque;
  std::vector<Change> m_change;  // by m_bodies: what a unit impulse does
  std::vector<int> m_answering;  // in m_bodies: who answers to it
  std::vector<JointImpact> m_impacts;
};

}  // namespace naiad::physics
