// A joint between two bodies, or a body and the world. The PM.add… functions make joints and return one:
//
//   df::Joint rope = PM.addRope(p_hook, p_crate);
//   df::Joint axle = PM.addHinge(p_wheel, nullptr, p_wheel->getPosition());   // null: the world
//   axle.setBreakForce(20);
//
// A Joint is a handle: copying or destroying it does not affect the joint. The joint ends when it is removed,
// when it breaks, or when one of its bodies is deleted. After that exists() is false and setters return −1.
// Joined bodies do not collide with each other.
#pragma once

#include <cstdint>
#include <memory>

#include "Vector.h"

namespace naiad::physics {
class BodyTable;
struct JointEntry;

/// Identifies a joint of a table by an index that may be reused, and a generation that is never reused.
struct JointKey {
  std::uint32_t index = 0;
  std::uint32_t generation = 0;  ///< 0: no joint
};
}  // namespace naiad::physics

namespace df {

/// Setters return 0. They return -1 and change nothing for numbers that are not finite or out of range, for a
/// joint that does not exist any more, and for a kind of joint without that setting.
class Joint {
 public:
  /// Refers to no joint.
  Joint() = default;

  /// True while the joint exists.
  bool exists() const;
  /// Removes the joint. Returns 0, or -1 if it does not exist.
  int remove();

  /// Sets the force at which the joint breaks: it breaks if its mean force over a tick is larger. In mass ·
  /// cell widths per tick², >= 0; infinity by default.
  int setBreakForce(double force);
  /// Like setBreakForce(), for the torque that holds the angle, in force · cell widths.
  int setBreakTorque(double torque);
  /// Sets the length of a distance joint (> 0), the maximum length of a rope (> 0) or the rest length of a
  /// spring (>= 0), in cell widths, to 1e30.
  int setLength(double length);
  /// Returns the length in cell widths; 0 if the joint does not exist.
  double getLength() const;
  /// Sets stiffness (mass per tick²) and damping (mass per tick) of a spring or mouse joint; both 0 … 1e30.
  int setStiffness(double stiffness, double damping);
  /// Sets a motor's speed: that of the second body relative to the first, radians per tick, −1e30 … 1e30.
  int setSpeed(double speed);
  /// Sets a motor's maximum torque, or a mouse joint's maximum force along each axis; >= 0, may be infinity.
  int setStrength(double strength);
  /// Angle-limit joints only. Sets the limits of the angle of the second body relative to the first, in
  /// radians: −π < lower <= upper < π.
  int setLimits(double lower, double upper);
  /// Mouse joints only. Sets the point to which the body is pulled, in cells.
  int setTarget(Vector target);

  /// Returns the mean force on the second body in the last tick, mass · cells / tick²; (0,0) without a joint.
  Vector getForce() const;
  /// Like getForce(), for the torque, in force · cell widths.
  double getTorque() const;

 private:
  friend class PhysicsManager;
  Joint(std::shared_ptr<naiad::physics::BodyTable> table, naiad::physics::JointKey key)
      : m_table(std::move(table)), m_key(key) {}
  naiad::physics::JointEntry* find() const;

  std::shared_ptr<naiad::physics::BodyTable> m_table;  // null: no joint
  naiad::physics::JointKey m_key;
};

}  // namespace df
