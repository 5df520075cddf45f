// Settings for all bodies of the current world, and the joints between them.
#pragma once

#include <cstdint>

#include "BodyJoint.h"
#include "Integrator.h"
#include "Manager.h"
#include "Vector.h"

/// The physics manager, also after PathManager.h, whose macro has this name, too.
#undef PM
#define PM df::PhysicsManager::getInstance()

namespace naiad::physics {
struct Joint;
}

namespace df {

class Body;

/// The kind of solver that moves bodies. Objects, drawing and events are alike; only the paths differ.
enum Accuracy {
  ACCURACY_DEFAULT,  ///< impacts at their exact moment; joints and piles solved directly where affordable
  ACCURACY_FAST,     ///< all HARD and all joined bodies move in soft sub-steps (docs/physics/substep.md)
};

/// Like all managers it works on the current world and has no state of its own. Setters return 0. For numbers
/// that are not finite or out of range they return -1, change nothing, and the world counts the refusal
/// (WorldLog::refusals).
class PhysicsManager : public Manager {
 public:
  static PhysicsManager& getInstance();

  /// Sets the acceleration of every body, multiplied by its gravity scale, in cells per tick², −1e30 … 1e30
  /// on each axis; (0,0) by default.
  int setGravity(Vector gravity);
  Vector getGravity() const;
  /// Sets the height of a character cell over its width, 0.25 … 4; 2 by default. Lengths, angles and circles
  /// look right if it is the true aspect of the screen. Returns -1 while there are bodies.
  int setAspect(double aspect);
  double getAspect() const;
  /// Sets how fields (Field.h) are integrated; docs/physics/flight.md compares the methods. Tolerances are in
  /// (0, 1], limits of steps and evaluations 1 … 1e7.
  int setIntegrator(const naiad::physics::IntegratorOptions& options);
  const naiad::physics::IntegratorOptions& getIntegrator() const;

  /// Sets the friction of HARD Objects that are not bodies, 0 … 1e30, 0.5 by default, and their restitution,
  /// 0 … 1, 0 by default. See Body::setFriction and setRestitution.
  int setObstacleFriction(double friction);
  double getObstacleFriction() const;
  int setObstacleRestitution(double restitution);
  double getObstacleRestitution() const;

  /// Chooses the solver from the next tick on. ACCURACY_DEFAULT by default; returns −1 for any other value.
  int setAccuracy(Accuracy accuracy);
  Accuracy getAccuracy() const;
  /// Lets groups of resting bodies sleep: they cost almost nothing, and wake when touched. True by default.
  void setSleeping(bool may_sleep);
  bool isSleeping() const;

  // Joints. At least one side must be a body of the current world. Null is the world itself in functions with
  // points, and as `p_a` of addMotor() and addAngleLimit(). Points and directions are world coordinates in
  // cells, for the bodies' present positions; lengths are in cell widths. A body of another world, the same
  // body twice, and numbers that are not finite or out of range are refused and counted; the joint returned
  // then does not exist (Joint::exists).

  /// Adds a rod, which keeps the two points at their present distance.
  Joint addDistance(Body* p_a, Body* p_b, Vector point_a, Vector point_b);
  /// Like addDistance() with points, between the positions of two bodies.
  Joint addDistance(Body* p_a, Body* p_b);
  /// Adds a rope: the distance of the points stays at most the present one, or `length` > 0.
  Joint addRope(Body* p_a, Body* p_b, Vector point_a, Vector point_b);
  Joint addRope(Body* p_a, Body* p_b);
  Joint addRope(Body* p_a, Body* p_b, double length);
  /// Adds a hinge: both bodies turn about this shared point.
  Joint addHinge(Body* p_a, Body* p_b, Vector point);
  /// Adds a weld: the bodies keep their relative position and angle.
  Joint addWeld(Body* p_a, Body* p_b, Vector point);
  /// Adds a slider: `point`, fixed to the second body, slides along the line through it with direction
  /// `axis`, fixed to the first. The bodies do not turn relative to each other. `p_b` must not be null.
  Joint addSlider(Body* p_a, Body* p_b, Vector point, Vector axis);
  /// Adds a spring that pulls the points to their present distance (Joint::setLength changes it): force =
  /// `stiffness` · stretch + `damping` · its rate. They are 0 … 1e30, in mass per tick² and mass per tick.
  Joint addSpring(Body* p_a, Body* p_b, Vector point_a, Vector point_b, double stiffness, double damping = 0);
  Joint addSpring(Body* p_a, Body* p_b, double stiffness, double damping = 0);
  /// Adds a motor: turns the second body relative to the first at `speed` (radians per tick), with a torque
  /// of at most `strength` >= 0 (force · cell widths). `p_b` must not be null.
  Joint addMotor(Body* p_a, Body* p_b, double speed, double strength);
  /// Adds an angle limit: keeps the angle of the second body relative to the first (radians, 0 at present)
  /// between `lower` and `upper`: −π < lower <= 0 <= upper < π. `p_b` must not be null.
  Joint addAngleLimit(Body* p_a, Body* p_b, double lower, double upper);
  /// Adds a mouse joint: drags a point of the body towards Joint::setTarget(), initially the point itself. It
  /// is a critically damped spring of one radian per tick, with a force of at most `strength` on each axis.
  Joint addMouse(Body* p_body, Vector grabbed, double strength);
  int getJointCount() const;

  /// Returns the number of bodies, including removed ones that are not deleted yet.
  int getBodyCount() const;
  /// Returns how often a body was frozen (Body::isFrozen).
  std::uint64_t getQuarantineCount() const;
  /// Returns how often a body's acceleration, speed, spin or position was reduced to the limit: 16777216
  /// cells and 1e6 radians per tick, 2e9 cells from the origin. The body continues with the limit.
  std::uint64_t getLimitCount() const;

 private:
  PhysicsManager() { setType("PhysicsManager"); }
  int refuseAs(const char* what) const;
  Joint refuseJoint(const char* what) const;
  Joint add(const char* what, naiad::physics::Joint joint, Body* p_a, Body* p_b, Vector point_a,
            Vector point_b) const;
};

}  // namespace df
