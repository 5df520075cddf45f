// A linkage: the rigid joints of a group of joined bodies, which are rods, hinges, welds, sliders, and
// ropes and angle limits while they act.
//
// It also knows the group's springs, for the energy. It is alone if the group has no other joints, and no
// shapes, so that nothing can touch it. Then each of its sub-steps is one of RATTLE (Andersen 1983). First
// come half of the change of velocity by acceleration, and impulses along the joints at their present places,
// so that the joints are closed at the next places. Then the bodies move. Last come the other half, and
// impulses that remove the speeds along the joints. Both solutions use one JointMatrix, whose factorisation
// takes O(n) for a tree.
//
// In other groups, RigidDirect finds the velocities, with contacts and bounds. Then the linkage adds the
// impulses that close the joints.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "physics/numerics/JointMatrix.h"
#include "physics/rigid/RigidBody.h"
#include "physics/rigid/RigidContact.h"
#include "physics/rigid/RigidJoint.h"

namespace naiad::physics {

/// Counters over all linkages.
struct LinkageCounters {
  std::int64_t substeps = 0;
  std::int64_t iterations = 0;   ///< Newton iterations of all sub-steps
  std::int64_t refined = 0;      ///< steps repeated with shorter sub-steps, because one did not converge
  std::int64_t missed = 0;       ///< sub-steps of linkages that are not alone whose velocities lead nowhere
  std::int64_t approximate = 0;  ///< steps that are bounded, but not exact: no sub-step was short enough
};

inline bool isMovable(const JointMass& mass) {
  return mass.inverse_mass > 0 || mass.inverse_inertia > 0;
}

/// The change of a body's motion by a unit impulse somewhere.
struct BodyChange {
  int body = -1;
  Vec2 velocity;
  double spin = 0;
};

class RigidLinkage {
 public:
  /// True if a linkage can have this joint.
  static bool canHave(const Joint& joint) { return canBeAlone(joint) || isOneSided(joint.kind); }
  /// True if the joint has a row only while it acts.
  static bool isOneSided(JointKind kind) {
    return kind == JointKind::kRope || kind == JointKind::kAngleLimit;
  }
  /// True if a linkage that is alone can have this joint.
  static bool canBeAlone(const Joint& joint);
  /// Makes a linkage of these joints, which connect all of its movable bodies.
  RigidLinkage(std::span<const int> ids, const JointStore& store, std::span<const RigidBody> bodies);
  /// True if a new linkage of these joints would be equal to this one.
  bool isSame(std::span<const int> ids, const JointStore& store, std::span<const RigidBody> bodies) const {
    return keyOf(ids, store, bodies) == m_key;
  }

  void setKind(bool is_pure, bool is_alone) {
    m_is_pure = is_pure;
    m_is_alone = is_pure && is_alone;
  }
  bool isPure() const { return m_is_pure; }
  bool isAlone() const { return m_is_alone; }
  /// True if its bodies may be swept from impact to impact, because it is small and has only rigid joints.
  bool mayFly() const { return m_is_pure && !m_is_alone && m_nodes.size() <= kMostFlying; }
  /// True if the step began with a linkage that is not alone, or it was hit since.
  bool isBegun() const { return m_is_begun; }
  void setUnbegun() { m_is_begun = false; }

  /// Call at the start of a step of a linkage that is not alone.
  void begin(std::span<const RigidBody> bodies, std::span<const RigidState> states,
             const RigidJoints& joints);
  /// Removes the speeds along the joints. Replaces RigidDirect for a linkage that is pure and touches
  /// nothing.
  void project(std::span<RigidState> states, RigidJoints& joints);
  /// Changes the velocities so that the joints fit where the bodies arrive after h. Does nothing if there are
  /// no such velocities nearby.
  void aim(std::span<RigidState> states, RigidJoints& joints, double h, LinkageCounters& counters);
  /// Moves the bodies to the nearest places where the joints fit, without a change of their velocities.
  void fit(std::span<RigidState> states);

  /// Call at the end of the sub-step. If there were no velocities that aim() looked for, removes the kinetic
  /// energy that the sub-step has added.
  void damp(std::span<RigidState> states);

  /// Call at an impact, with the states of its time and before respond(). Removes the speeds along the
  /// joints.
  void meet(std::span<RigidState> states);
  /// Pushes a body; respond() finds the effect.
  void push(int body, Vec2 impulse, double turning);
  /// Appends how the movable bodies respond to the pushes since the last call.
  void respond(std::vector<BodyChange>& changes);
  /// Adds the impulses of the joints, found by the last respond(), to their forces.
  void addImpact(RigidJoints& joints) const;
  /// Call after meet(). Changes the velocities so that the joints fit where the bodies arrive after h.
  void lead(std::span<RigidState> states, double h, LinkageCounters& counters);

  /// Call at the end of a step in which nothing touched the linkage. Unless something drives it, changes its
  /// speeds so that it gains no energy, and loses none if no joint takes any.
  void limitEnergy(std::span<const RigidBody> bodies, std::span<RigidState> states);

  /// If the linkage is pure and nothing touched it: moves the bodies by a tick from their state in `bodies`,
  /// and writes the result to `states`. Returns the number of joints that broke.
  int step(std::span<const RigidBody> bodies, std::span<RigidState> states, RigidJoints& joints,
           LinkageCounters& counters);

  /// Returns one of its movable bodies.
  int someBody() const { return m_some_body; }
  /// Calls visit(body) for every body with a joint.
  template <class Visit>
  void visitBodies(Visit visit) const {
    for (const Node& node : m_nodes) visit(node.body);
  }
  /// Calls visit(a, b) for every joint.
  template <class Visit>
  void visitLinks(Visit visit) const {
    const auto bodyOf = [&](int node) { return m_nodes[static_cast<std::size_t>(node)].body; };
    for (const Link& link : m_links) visit(bodyOf(link.a), bodyOf(link.b));
    for (const Spring& spring : m_springs) visit(spring.a, spring.b);
  }

 private:
  static constexpr double kTolerance =
      1e-11;  // metric cells or rad, or the rounding of the largest coordinate
  static constexpr std::size_t kMostFlying = 32;
  static constexpr double kAimed = 1e-9;  // error of a sub-step that is not exact, or of a linkage not alone
  // Limit of the part by which a step may change speeds so that the energy is exact. A larger error, as in
  // bodies that almost rest, is left.
  static constexpr double kEnergyFactor = 0.01;

  struct Node {  // a body; displacement and turn are since the start of the step
    Vec2 velocity;
    double spin;
    Vec2 displacement, displacement_before;  // now, and at the start of the sub-step
    Rotation turn, turn_before;
    Vec2 acceleration, growth;  // `growth`: change of the acceleration from a sub-step to the next
    double spin_acceleration;
    Vec2 origin;  // place at the start of the step, relative to the first node
    int body;
  };
  struct Link {  // a joint
    int id;
    JointKind kind;
    bool is_active;   // false for a slack rope
    int side;         // as in SpeedRow
    bool is_rod;      // a rod between the bodies' centres
    bool may_rotate;  // no body without rotation prevents the joint from rotating as a whole
    int a, b;         // indices of nodes
    int row[3];
    int count;
    int angle_row;  // which of the rows holds an angle; −1: none
    double square, half_inverse_length;
    Vec2 arm_a, arm_b, offset, axis;  // at the start of the step
    Rotation between;
    Vec2 force;
    double torque;
  };
  struct Spring {  // a joint without rows; a is −1 for a mouse joint
    int id, a, b;  // a and b are bodies
  };
  struct Rod {    // a row of a linkage that has only rods between centres
    Vec2 offset;  // at the start of the sub-step
    double square, half_inverse_length;
    int a, b;
  };
  struct Motion {  // the motion of the whole linkage like a rigid body, if it hangs on nothing
    Vec2 centre, velocity;
    double spin = 0;
    double kinetic = 0;  // kinetic energy of all bodies
    double inner = 0;    // kinetic energy of the motion relative to that of a rigid body
  };

  static std::vector<std::int64_t> keyOf(std::span<const int> ids, const JointStore& store,
                                         std::span<const RigidBody> bodies);
  void loadLinks(std::span<const RigidBody> bodies, const RigidJoints& joints);
  void takeStates(std::span<const RigidState> states);
  void load(std::span<const RigidBody> bodies, const RigidJoints& joints, int substeps);
  double rateOf(std::span<const RigidBody> bodies, const RigidJoints& joints) const;
  bool run(std::span<const double> lengths, LinkageCounters& counters);
  bool substep(double h, LinkageCounters& counters);
  bool solvePlaces(double h, LinkageCounters& counters);
  void findSpeedImpulses();
  void projectSpeeds();
  void giveVelocities(std::span<RigidState> states) const;
  void givePlaces(std::span<RigidState> states) const;
  void giveImpulses(const std::vector<double>& impulse, RigidJoints& joints) const;
  void approximate(double h);
  bool findPlaces(double h, double tolerance);
  void findActive(RigidJoints& joints, double h);
  void slowLightNodes();
  double limitMasses();
  void restoreMomentum(std::span<const RigidBody> bodies);
  void kick(double h);
  void move(double h);
  void apply(const std::vector<double>& impulse);
  void applyToRods(const double* impulse);
  double errorsOfRods(double h);
  double errors(double h);
  void addForces(const std::vector<double>& impulse);
  void factor(double regularisation);
  double speedAlong(const JointRow& row) const;
  // Sets m_rest to the position errors; with `kJacobian`, also sets m_rows. Returns the largest error.
  template <bool kJacobian>
  double evaluate(const RigidJoints& joints);
  Motion motion() const;
  double work(bool is_whole_step) const;
  double springEnergy(std::span<const RigidBody> bodies, std::span<const RigidState> states) const;
  void setKinetic(double kinetic, double least, double most);

  std::vector<std::int64_t> m_key;
  std::vector<Node> m_nodes;
  std::vector<JointMass> m_mass;  // by node
  std::vector<Link> m_links;
  std::vector<Spring> m_springs;
  std::vector<JointRow> m_rows;           // in elimination order, like the following ones
  std::vector<double> m_first, m_second;  // impulses of the two halves of a sub-step
  std::vector<double> m_rest;
  std::vector<Rod> m_rods;  // by row, if all joints are rods between centres and no body turns
  std::vector<Vec2> m_velocity_before;
  std::vector<double> m_spin_before;
  JointMatrix m_matrix;
  const RigidJoints* m_p_joints = nullptr;  // during a step
  double m_tolerance = 0;
  double m_last_h = 0;  // length of the sub-step to which m_first belongs
  int m_some_body = -1;
  double m_kinetic = -1;      // kinetic energy at the last aim(), if that failed; otherwise −1
  double m_start_energy = 0;  // kinetic energy and that of springs at the start of the step
  bool m_has_motor = false;
  bool m_is_begun = false;
  bool m_is_factored = false;  // the matrix is that of the present places
  bool m_is_new = false;       // no impulses are known
  bool m_is_pure = false, m_is_alone = false;
  bool m_is_free = false;          // no body is immovable
  bool m_may_rotate = false;       // it is free and may rotate like a rigid body
  bool m_is_conservative = false;  // only constant forces act in this step
};

}  // namespace naiad::physics
