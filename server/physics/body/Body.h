// An Object with mass. Forces move it by Newton's laws, while other Objects only move by their velocity.
//
//   class Ball : public df::Body {
//    public:
//     Ball() { setMass(2); setVelocity(df::Vector(0.5, -1)); }
//   };
//   PM.setGravity(df::Vector(0, 0.02));
//
// Within a tick a body's path is computed exactly where a formula exists (docs/physics/flight.md), so no step
// is too long. HARD bodies collide with, rest on and slide along each other and HARD Objects; SOFT ones get
// contact events but push nothing; SPECTRAL ones touch nothing (docs/physics/bodies.md). Units are cells,
// ticks and a mass unit that the game chooses; Seconds.h converts from seconds. Everything else works as in
// any Object; changes of position or velocity not made by Body's setters take effect in the next tick.
//
// Setters return 0. For numbers that are not finite or out of range they return -1, change nothing, and the
// world counts the refusal (WorldLog::refusals).
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "BodyDrawing.h"
#include "ConvexShape.h"
#include "Object.h"
#include "Vector.h"

namespace naiad::physics {
class BodyLook;
class BodyTable;
struct BodyGeometry;
struct BodyRow;
}  // namespace naiad::physics

namespace df {

class Field;

class Body : public Object {
 public:
  /// Creates an Object of mass 1 in the current world.
  Body();
  Body(const Body&) = delete;
  Body& operator=(const Body&) = delete;
  ~Body() override;

  /// Mass, 1e-30 … 1e30, in the game's unit; 1 by default.
  int setMass(double mass);
  double getMass() const;
  /// Factor of the world's gravity (PM.setGravity), −1e30 … 1e30; 1 by default, 0 for no gravity.
  int setGravityScale(double scale);
  double getGravityScale() const;
  /// Makes the body kinematic, like a lift or a mill: it ignores gravity and keeps its velocity and spin,
  /// whatever pushes it. Off by default.
  void setKinematic(bool kinematic = true);
  bool isKinematic() const;

  // Contacts.

  /// Coefficient of restitution: the part of the impact speed that a bounce leaves, 0 (clay, the default) … 1
  /// (no loss). Of two bodies, the larger coefficient counts.
  int setRestitution(double restitution);
  double getRestitution() const;
  /// Coulomb's coefficient of friction, 0 (ice) … 1e30; 0.5 by default. Two bodies have the geometric mean.
  int setFriction(double friction);
  double getFriction() const;
  /// If set, this body gets an EventContactEnd when a contact ends. Off by default.
  void setContactEnds(bool contact_ends = true);
  bool hasContactEnds() const;

  // Shape: the Object's box, unless one of these functions sets another and fits the Object's box around it.
  // Lengths are in cells, like positions, but a radius is in cell widths. A shape must be at least 1e-6 cell
  // widths wide and reach at most 1e7 from the position; others are refused.

  /// Uses the Object's own box again, and follows later setBox() calls. The position need not be its centre.
  int setBoxShape();
  /// Sets a box of this size, centred on the position. Unlike setBox(), it turns with the body.
  int setBoxShape(double width, double height);
  /// Sets a circle around the position, drawn as round as the cell aspect allows.
  int setCircle(double radius);
  /// Sets a convex polygon of 3 to 16 corners, clockwise or counterclockwise, moved so that the position is
  /// its centre of mass. Also returns -1 if the polygon is not convex.
  int setPolygon(const std::vector<Vector>& corners);
  /// Adds one more part; several parts make a compound. (The Object's box is not a part.) `centre` and
  /// `corners` are relative to the centre of mass before the call. Then all parts are moved so that the
  /// position is the centre of mass of the whole.
  int addCircle(double radius, Vector centre);
  /// Like addCircle(), for a box. `angle` is in radians, −1e6 … 1e6.
  int addBoxShape(double width, double height, Vector centre, double angle = 0);
  int addPolygon(const std::vector<Vector>& corners);
  /// Returns the shapes in cell widths, relative to the position and not rotated, for classes that draw them.
  /// Empty if the shape is the Object's box. Copy the result to keep it: changing any body may move it.
  const std::vector<naiad::physics::ConvexShape>& getShapes() const;

  // Rotation. Angles are in radians, clockwise on the screen.

  /// Lets forces and impacts turn the body. Off by default: then only a spin set by the game turns it. The
  /// moment of inertia is that of the shape, evenly filled with the mass.
  void setTurning(bool turning = true);
  bool isTurning() const;
  /// Sets the angle, −1e6 … 1e6; getAngle() returns it in [−π, π].
  int setAngle(double angle);
  double getAngle() const;
  /// Sets the spin in radians per tick, −1e6 … 1e6.
  int setSpin(double spin);
  double getSpin() const;
  /// Returns the moment of inertia about the centre of mass, in mass · (cell widths)².
  double getInertia() const;

  // Positions and velocities are doubles here; those of other Objects are rounded to 2^-32 cell.

  /// Sets the position in cells, up to ±2e9. Unfreezes a frozen body.
  int setPosition(Vector position) override;
  Vector getPosition() const;
  /// Returns the displacement in cells from a point of the world to the position, equally exact near and far
  /// from the origin. (0,0) for a point out of range.
  Vector getDisplacementFrom(Vector point) const;
  [[deprecated("say getDisplacementFrom")]] Vector getWayFrom(Vector point) const {
    return getDisplacementFrom(point);
  }
  /// Sets the velocity in cells per tick, up to ±16777216. Unfreezes a frozen body.
  DF_SETTER setVelocity(Vector velocity) override;
  Vector getVelocity() const;

  /// Pushes the body during the next tick, in mass · cells per tick². Several pushes add up; limit: ±1e30.
  int applyForce(Vector force);
  /// Changes the velocity at once, by impulse / mass (mass · cells / tick). Returns -1 if that is too fast.
  int applyImpulse(Vector impulse);
  /// Like applyImpulse(), at a point of the world; also changes the spin if the body may turn.
  int applyImpulseAt(Vector impulse, Vector where);
  /// Applies a torque during the next tick, in force · cell widths. Several torques add up; limit: ±1e30.
  int applyTorque(double torque);

  /// Sets drag: force over mass is `linear` · velocity + `quadratic` · velocity · |velocity|. `linear` is per
  /// tick, `quadratic` per cell width; both 0 … 1e30, 0 by default.
  int setDrag(double linear, double quadratic = 0);
  /// Sets a spring of rest length 0 to a point of the world: force over mass is `stiffness` · displacement +
  /// `damping` · velocity. `stiffness` is per tick², `damping` per tick, both 0 … 1e30; both 0 removes it.
  int setSpring(Vector anchor, double stiffness, double damping = 0);
  /// Puts the body into a field with its origin at `origin` (cells); null removes it. The field must outlive
  /// the body or its next setField() call.
  int setField(const Field* p_field, Vector origin = Vector());

  /// True if the body is in quarantine because its motion has no finite solution (for example at a field's
  /// singularity). It stands still until its position or velocity is set.
  bool isFrozen() const;

  // Drawing. Unless the class overrides draw(), it draws the shape in character cells, at the body's angle.

  /// Draws the body as an outline (the default), filled, or not at all, with the character `ch`. If `ch` is
  /// 0, an outline has characters by the direction of the edge, and a filling has #. Returns 0, else -1.
  int setDrawing(BodyDrawing drawing, char32_t ch = 0, Color color = COLOR_DEFAULT);
  /// Draws the body as a sprite that turns with it: up to 128 rows (UTF-8) of up to 128 characters, centred
  /// on the position; blanks are transparent. Returns 0, else -1.
  int setDrawing(const std::vector<std::string>& rows, Color color = COLOR_DEFAULT);
  /// Draws the body. A constant spin is sent to clients only once, like a constant velocity.
  int draw() override;

 private:
  friend class PhysicsManager;

  naiad::physics::BodyRow& row() const;
  naiad::physics::BodyGeometry& form() const;
  int setShapes(std::vector<naiad::physics::ConvexShape> shapes);
  int addShape(const naiad::physics::ConvexShape& shape);
  void fitBox();
  int refuseAs(const char* what) const;
  void syncFromStore() const;
  naiad::physics::BodyLook& look();

  std::shared_ptr<naiad::physics::BodyTable> m_table;
  std::uint32_t m_index;                             ///< index in m_table
  std::shared_ptr<naiad::physics::BodyLook> m_look;  ///< null until setDrawing() or draw()
};

}  // namespace df
