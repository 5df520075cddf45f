// A joint between two bodies, or a body and the world. PM.add… makes it and hands out one of these:
//
//   df::Joint rope = PM.addRope(p_hook, p_crate);
//   df::Joint axle = PM.addHinge(p_wheel, nullptr, p_wheel->getPosition());   // null: the world
//   axle.setBreakForce(20);
//
// A value: copy it, keep it, throw it away; the joint stays. It goes when it is removed, when it breaks, and
// with either of its bodies; then exists() says so, setters return −1, and nothing else happens. Bodies that
// are joined do not collide with each other.
#pragma once

#include <cstdint>
#include <memory>

#include "Vector.h"
#include "detail/BodyJoints.h"

namespace naiad::physics {
class BodyTable;
}

namespace df {

/// Setters return 0, or -1 (and no change) for numbers that are not finite or out of range, for a joint that
/// is gone, and for a kind of joint that has no such thing.
class Joint {
 public:
  /// No joint.
  Joint() = default;

  bool exists() const;
  /// Return 0, or -1 if it is gone.
  int remove();

  /// Breaks when it has to hold with more than this, as a mean over a tick. Mass · widths of a cell per
  /// tick²; infinity by default.
  int setBreakForce(double force);
  /// The same for what holds the angle. Force · widths of a cell.
  int setBreakTorque(double torque);
  /// Of a distance (> 0), a rope (> 0, its greatest) or a spring (>= 0, when it is slack). Widths of a cell.
  int setLength(double length);
  double getLength() const;
  /// Of a spring or a mouse. Force per width of a cell; force per (width of a cell per tick).
  int setStiffness(double stiffness, double damping);
  /// Of a motor: radians per tick, of the second body against the first.
  int setSpeed(double speed);
  /// Of a motor the greatest torque, of a mouse the greatest force along each axis.
  int setStrength(double strength);
  /// Of an angle limit: −π < lower <= upper < π, of the second body against the first.
  int setLimits(double lower, double upper);
  /// Of a mouse: where to pull.
  int setTarget(Vector target);

  /// What it did to the second body in the last tick, as a mean. Mass · cells per tick².
  Vector getForce() const;
  double getTorque() const;

 private:
  friend class PhysicsManager;
  Joint(std::shared_ptr<naiad::physics::BodyTable> table, naiad::physics::JointKey key)
      : m_table(std::move(table)), m_key(key) {}
  naiad::physics::BodyJoints::Entry* find() const;

  std::shared_ptr<naiad::physics::BodyTable> m_table;  // null: no joint
  naiad::physics::JointKey m_key;
};

}  // namespace df
