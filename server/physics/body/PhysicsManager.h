// What holds for all bodies of the current world, and what joins them.
#pragma once

#include <cstdint>

#include "BodyJoint.h"
#include "Integrator.h"
#include "Manager.h"
#include "Vector.h"

#define PM df::PhysicsManager::getInstance()

namespace df {

class Body;

/// Holds no state of its own, as all managers. Setters return 0, or -1 (and no change) for numbers that are
/// not finite or out of range.
class PhysicsManager : public Manager {
 public:
  static PhysicsManager& getInstance();

  /// Cells per tick², for every body by its gravity scale; (0,0) by default.
  int setGravity(Vector gravity);
  Vector getGravity() const;
  /// Height of a character cell over its width, 0.25 … 4; 2 by default. Lengths, angles and circles are what
  /// they seem on such a screen. Only while there are no bodies.
  int setAspect(double aspect);
  double getAspect() const;
  /// How fields are integrated; docs/physics/flight.md has the table. Returns -1 for settings out of range.
  int setIntegrator(const naiad::physics::IntegratorOptions& options);
  const naiad::physics::IntegratorOptions& getIntegrator() const;

  /// Of HARD Objects that are no bodies: 0.5 and 0 by default. See Body::setFriction, setRestitution.
  int setObstacleFriction(double friction);
  double getObstacleFriction() const;
  int setObstacleRestitution(double restitution);
  double getObstacleRestitution() const;

  // Joints. At least one of the two is a body of the current world; null is the world itself. Points and
  // directions are in cells, of the world, as the bodies lie now; lengths in widths of a cell. What cannot be
  // made is refused: then the joint that is returned does not exist (Joint::exists).

  /// A rod: the points stay as far apart as they are.
  Joint addDistance(Body* p_a, Body* p_b, Vector point_a, Vector point_b);
  /// The same between the positions of two bodies.
  Joint addDistance(Body* p_a, Body* p_b);
  /// The points get no farther apart than they are, or than `length`.
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
  /// stretch + `damping` · its rate. Both >= 0, as stiff as you like.
  Joint addSpring(Body* p_a, Body* p_b, Vector point_a, Vector point_b, double stiffness, double damping = 0);
  Joint addSpring(Body* p_a, Body* p_b, double stiffness, double damping = 0);
  /// Turns the second against the first at `speed` (radians per tick), with at most `strength` as torque.
  Joint addMotor(Body* p_a, Body* p_b, double speed, double strength);
  /// Keeps the angle of the second against the first, 0 as they lie now, between these: −π < lower <= 0 <=
  /// upper < π.
  Joint addAngleLimit(Body* p_a, Body* p_b, double lower, double upper);
  /// Drags a body by a point of it towards Joint::setTarget(), at first where it is: soft, without
  /// oscillation, within some ticks, with at most `strength` as force.
  Joint addMouse(Body* p_body, Vector grabbed, double strength);
  int getJointCount() const;

  /// Bodies in the world, removed ones included.
  int getBodyCount() const;
  /// Bodies that were frozen so far (Body::isFrozen).
  std::uint64_t getQuarantineCount() const;

 private:
  PhysicsManager() { setType("PhysicsManager"); }
  Joint refuseJoint(const char* what) const;
  Joint add(const char* what, naiad::physics::Joint joint, Body* p_a, Body* p_b, Vector point_a,
            Vector point_b) const;
};

}  // namespace df
