// Positions and velocities of an island's bodies: arrays by body, relative to one origin.
#pragma once

#include <cmath>
#include <span>
#include <vector>

#include "physics/joint/Joint.h"
#include "physics/numerics/JointMatrix.h"

namespace naiad::physics {

/// Limit of coordinates (in metric cells), speeds and accelerations within an island: beyond it, a double
/// does not resolve a cell.
inline constexpr double kMaxJointMotion = 1e15;

inline bool isBelow(Vec2 a, double limit) {
  return std::abs(a.x) <= limit && std::abs(a.y) <= limit;
}

inline Vec2 accelerationOf(const JointBody& body, Vec2 gravity) {
  return body.inverse_mass > 0 ? gravity + body.inverse_mass * body.force : Vec2{};
}

struct JointMotion {
  JointMotion(std::span<const int> bodies, std::span<const JointBody> all_bodies);

  /// Reads the bodies. Returns false if a number is out of range.
  bool load(std::span<const JointBody> all_bodies, Vec2 gravity);
  /// Writes the movable bodies. Returns false and writes nothing if a number is out of range.
  bool store(std::span<JointBody> all_bodies) const;
  void storeVelocities(std::span<JointBody> all_bodies) const;
  /// Sets the velocities and spins of the movable bodies in `all_bodies` to zero.
  void halt(std::span<JointBody> all_bodies) const;

  void save();
  void restore();
  void restoreVelocities();
  void saveKicked();
  void restoreKicked();

  /// Advances velocities by `h` under the constant forces.
  void kick(double h);
  /// Computes positions from the saved ones by motion over `h` at the present velocities.
  void move(double h);
  /// Applies one impulse per row. `is_rods`: every row has two bodies and turns neither of them.
  void applyImpulses(std::span<const JointRow> rows, const double* impulse, bool is_rods);
  /// Returns the relative velocity along a row: J·v.
  double speedAlong(const JointRow& row) const;

  /// Limits each speed to that of the heaviest body, and stops all spins, so that a light chain on a heavy
  /// weight does not whirl.
  void slowLightBodies();
  void stopAll();
  void scaleVelocities(double factor);
  double kineticEnergy() const;
  /// Returns the work of the constant forces since save().
  double workSinceSave() const;

  std::vector<int> body;  ///< index of the body in the caller's arrays
  std::vector<JointMass> mass;
  std::vector<Vec2> place, velocity, acceleration;
  std::vector<Rotation> rotation;
  std::vector<double> spin, turn_acceleration;
  Place origin;
  double extent = 1;  ///< maximum coordinate at the last load(), at least 1
  bool is_turning = false;

 private:
  std::vector<Vec2> m_place_before, m_velocity_before, m_kicked;
  std::vector<Rotation> m_rotation_before;
  std::vector<double> m_spin_before, m_spin_kicked;
};

}  // namespace naiad::physics
