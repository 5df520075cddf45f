// Settings for all bodies of the current world, and the joints between them.
#pragma once

#include <cstdint>

#include "BodyJoint.h"
#include "Integrator.h"
#include "Manager.h"
#include "Vector.h"

/// The physics manager.
#define PM df::PhysicsManager::getInstance()

namespace naiad::physics {
struct Joint;
}

namespace df {

class Body;

/// How bodies are moved. No Object, picture or event is of another kind with one than with the other; paths
/// differ.
enum Accuracy {
  ACCURACY_DEFAULT,  ///< impacts at their moment, joints and piles solved for directly where that is
                     ///< affordable
  ACCURACY_FAST,     ///< all HARD and all joined bodies in soft sub-steps (docs/physics/substep.md)
};

/// Like all managers it works on the current world and holds no state of its own. Setters return 0, or -1 for
/// numbers that are not finite or out of range: then nothing changes, and the world counts it
/// (WorldLog::refusals).
class PhysicsManager : public Manager {
 public:
  static PhysicsManager& getInstance();

  /// Cells per tick², −1e30 … 1e30 on each axis, for every body times its gravity scale; (0,0) by default.
  int setGravity(Vector gravity);
  Vector getGravity() const;
  /// Height of a character cell over its width, 0.25 … 4; 2 by default. Lengths, angles and circles look
  /// right on such a screen. -1 while there are bodies.
  int setAspect(double aspect);
  double getAspect() const;
  /// How fields (Field.h) are integrated; docs/physics/flight.md compares the methods. Tolerances in (0, 1],
  /// sub-steps 1 … 1e4, limits of steps and evaluations 1 … 1e7.
  int setIntegrator(const naiad::physics::IntegratorOptions& options);
  const naiad::physics::IntegratorOptions& getIntegrator() const;

  /// Of HARD Objects that are no bodies: friction 0 … 1e30, 0.5 by default; restitution 0 … 1, 0 by default.
  /// See Body::setFriction, setRestitution.
  int setObstacleFriction(double friction);
  double getObstacleFriction() const;
  int setObstacleRestitution(double restitution);
  double getObstacleRestitution() const;

  /// From the next tick on. ACCURACY_DEFAULT at first. −1 for anything else.
  int setAccuracy(Accuracy accuracy);
  Accuracy getAccuracy() const;
  /// May groups of bodies at rest sleep? They cost next to nothing then, and wake when touched. True at
  /// first.
  void setSleeping(bool may_sleep);
  bool isSleeping() const;

  // Joints. At least one of the two is a body of the current world; null is the world itself, where a
  // function takes points. Points and directions are in cells, of the world, as the bodies lie now; lengths
  // in widths of a cell. Refused, and counted, are a body of another world, twice the same body, and numbers
  // that are not finite or out of range: then the joint that is returned does not exist (Joint::exists).

  /// A rod: the points stay as far apart as they are.
  Joint addDistance(Body* p_a, Body* p_b, Vector point_a, Vector point_b);
  /// The same between the positions of two bodies.
  Joint addDistance(Body* p_a, Body* p_b);
  /// The points get no farther apart than they are now, or than `length` > 0.
  Joint addRope(Body* p_a, Body* p_b, Vector point_a, Vector point_b);
  Joint addRope(Body* p_a, Body* p_b);
  Joint addRope(Body* p_a, Body* p_b, double length);
  /// Both turn about this point, which they share.
  Joint addHinge(Body* p_a, Body* p_b, Vector point);
  /// They stay as they lie to each other.
  Joint addWeld(Body* p_a, Body* p_b, Vector point);
  /// `point`, fixed to the second, slides on the line through it along `axis`, fixed to the first; they do
  /// not turn against each other.
  Joint addSlider(Body* p_a, Body* p_b, Vector point, Vector axis);
  /// Pulls the points to the distance that they have now (Joint::setLength changes it): force = `stiffness` ·
  /// stretch + `damping` · its rate. Mass per tick² and mass per tick, both 0 … 1e30.
  Joint addSpring(Body* p_a, Body* p_b, Vector point_a, Vector point_b, double stiffness, double damping = 0);
  Joint addSpring(Body* p_a, Body* p_b, double stiffness, double damping = 0);
  /// Turns the second against the first at `speed` (radians per tick), with a torque of at most `strength` >=
  /// 0 (force · widths of a cell). The second is a body.
  Joint addMotor(Body* p_a, Body* p_b, double speed, double strength);
  /// Keeps the angle of the second against the first (radians, 0 as they lie now) between these: −π < lower
  /// <= 0 <= upper < π. The second is a body.
  Joint addAngleLimit(Body* p_a, Body* p_b, double lower, double upper);
  /// Drags a body by a point of it towards Joint::setTarget(), at first where the point is: a critically
  /// damped spring of one radian per tick, with a force of at most `strength` >= 0 along each axis.
  Joint addMouse(Body* p_body, Vector grabbed, double strength);
  int getJointCount() const;  ///< Joints there are.

  /// Bodies in the world, removed ones included.
  int getBodyCount() const;
  /// How many times a body has been frozen so far (Body::isFrozen).
  std::uint64_t getQuarantineCount() const;
  /// How many times a body's acceleration, speed, spin or place was too large for a world, and was cut to the
  /// largest: 16777216 cells and 10^6 radians per tick, 2e9 cells from the origin. It goes on from there.
  std::uint64_t getLimitCount() const;

 private:
  PhysicsManager() { setType("PhysicsManager"); }
  int refuseAs(const char* what) const;
  Joint refuseJoint(const char* what) const;
  Joint add(const char* what, naiad::physics::Joint joint, Body* p_a, Body* p_b, Vector point_a,
            Vector point_b) const;
};

}  // namespace df
