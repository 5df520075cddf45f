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

namespace naiad::physics {
class BodyTable;
struct JointEntry;

/// Which joint of a table: an index that is used again, and a generation that is not.
struct JointKey {
  std::uint32_t index = 0;
  std::uint32_t generation = 0;  ///< 0: none
};
}  // namespace naiad::physics

namespace df {

/// Setters return 0, or -1 (and no change) for numbers that are not finite or out of range, for a joint that
/// is gone, and for a kind of joint without that setting.
class Joint {
 public:
  /// No joint.
  Joint() = default;

  /// Is the joint still there?
  bool exists() const;
  /// Return 0, or -1 if it is gone.
  int remove();

  /// It breaks when its mean force over a tick exceeds this. Mass · widths of a cell per tick², >= 0;
  /// infinity by default.
  int setBreakForce(double force);
  /// The same for the torque that holds the angle. Force · widths of a cell.
  int setBreakTorque(double torque);
  /// Of a distance (> 0), a rope (> 0, the greatest) or a spring (>= 0, the rest length). Widths of a cell,
  /// to 1e30.
  int setLength(double length);
  /// 0 for a joint that is gone.
  double getLength() const;
  /// Of a spring or a mouse: mass per tick² and mass per tick, both 0 … 1e30.
  int setStiffness(double stiffness, double damping);
  /// Of a motor: radians per tick, −1e30 … 1e30, of the second body against the first.
  int setSpeed(double speed);
  /// Of a motor the greatest torque, of a mouse the greatest force along each axis; >= 0, infinity too.
  int setStrength(double strength);
  /// Of an angle limit, in radians: −π < lower <= upper < π, of the second body against the first.
  int setLimits(double lower, double upper);
  /// Of a mouse: where to pull, in cells.
  int setTarget(Vector target);

  /// Its mean force on the second body in the last tick, mass · cells per tick²; (0,0) for a joint that is
  /// gone.
  Vector getForce() const;
  /// The same for the torque. Force · widths of a cell.
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
