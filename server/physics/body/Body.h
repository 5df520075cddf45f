// An Object with mass: forces move it, by Newton's laws instead of the book's steps.
//
//   class Ball : public df::Body {
//    public:
//     Ball() { setMass(2); setVelocity(df::Vector(0.5, -1)); }
//   };
//   PM.setGravity(df::Vector(0, 0.02));
//
// Within a tick a body's path is exact where mathematics has a formula for it (docs/physics/flight.md), so no
// step is too long. HARD bodies hit, rest on and slide along each other and HARD Objects; SOFT ones get
// contact events and push nothing; SPECTRAL ones touch nothing (docs/physics/bodies.md). Units: cells, ticks,
// and a mass of the game's choosing; Seconds.h converts. All the rest of an Object works as ever; a velocity
// or a position that is set from outside is taken over in the next tick.
//
// Setters return 0, or -1 for numbers that are not finite or out of range: then nothing changes, and the
// world counts it (WorldLog::refusals).
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
struct BodyForm;
struct BodyRow;
}  // namespace naiad::physics

namespace df {

class Field;

class Body : public Object {
 public:
  /// An Object of mass 1 in the current world.
  Body();
  Body(const Body&) = delete;
  Body& operator=(const Body&) = delete;
  ~Body() override;

  /// 1e-30 … 1e30, in the game's unit; 1 by default.
  int setMass(double mass);
  double getMass() const;
  /// Factor of the world's gravity (PM.setGravity), −1e30 … 1e30; 1 by default, 0: none.
  int setGravityScale(double scale);
  double getGravityScale() const;
  /// A kinematic body keeps its velocity and spin, whatever pushes it, and gravity does not move it: a lift,
  /// a mill. Off by default.
  void setKinematic(bool kinematic = true);
  bool isKinematic() const;

  // How it touches.

  /// Coefficient of restitution: how much of the speed of an impact is left, 0 (clay, the default) … 1
  /// (nothing is lost). Of two bodies the larger number counts.
  int setRestitution(double restitution);
  double getRestitution() const;
  /// Coulomb's µ, 0 (ice) … 1e30; 0.5 by default. Of two bodies the geometric mean counts.
  int setFriction(double friction);
  double getFriction() const;
  /// Does this body get an EventContactEnd when a contact ends? Off by default.
  void setContactEnds(bool contact_ends = true);
  bool hasContactEnds() const;

  // Its shape: the Object's box, unless one of these sets another. Each of them also fits the Object's box
  // around the shape. Lengths are in cells, as positions are, but a radius is in widths of a cell. A shape is
  // at least 1e-6 widths of a cell wide and reaches at most 1e7 from the position; anything else is refused.

  /// The Object's own box again, whatever setBox() makes of it; its middle need not be the position.
  int setBoxShape();
  /// A box of this size around the position. Unlike setBox(), it turns with the body.
  int setBoxShape(double width, double height);
  /// A circle around the position, as round as a cell's aspect lets it look.
  int setCircle(double radius);
  /// A convex polygon of 3 to 16 corners, in order either way round, moved so that the position is its centre
  /// of mass. -1 also if it is not convex.
  int setPolygon(const std::vector<Vector>& corners);
  /// One more part, so that the body is a compound. `centre` and `corners` count from the centre of mass of
  /// what was there; then all is moved so that the position is the centre of mass of the whole.
  int addCircle(double radius, Vector centre);
  /// `angle` in radians, −1e6 … 1e6.
  int addBoxShape(double width, double height, Vector centre, double angle = 0);
  int addPolygon(const std::vector<Vector>& corners);
  /// Its shapes in widths of a cell, relative to the position and not turned, for a class that draws them;
  /// empty: the Object's box. Copy it to keep it: a change of any body may move it.
  const std::vector<naiad::physics::ConvexShape>& getShapes() const;

  // How it turns. Angles are in radians, clockwise on the screen.

  /// May it turn? Off by default: then nothing turns it but a spin that the game sets. Its moment of inertia
  /// is that of its shape, evenly filled with its mass.
  void setTurning(bool turning = true);
  bool isTurning() const;
  /// −1e6 … 1e6; getAngle() returns it in [−π, π].
  int setAngle(double angle);
  double getAngle() const;
  /// Radians per tick, −1e6 … 1e6.
  int setSpin(double spin);
  double getSpin() const;
  /// Moment of inertia about the centre of mass, in mass · (widths of a cell)².
  double getInertia() const;

  // In doubles, where an Object's position and velocity are rounded to 2^-32 cell.

  /// Cells, to ±2e9. Thaws a frozen body.
  int setPosition(Vector position) override;
  Vector getPosition() const;
  /// From a point of the world to the position, in cells: as exact far from the origin as near it. (0,0) for
  /// a point out of range.
  Vector getDisplacementFrom(Vector point) const;
  [[deprecated("say getDisplacementFrom")]] Vector getWayFrom(Vector point) const {
    return getDisplacementFrom(point);
  }
  /// Cells per tick, to ±16777216. Thaws a frozen body.
  DF_SETTER setVelocity(Vector velocity) override;
  Vector getVelocity() const;

  /// Push it during the next tick; several pushes add up, to ±1e30. Mass · cells per tick².
  int applyForce(Vector force);
  /// Change its velocity at once, by impulse / mass. Mass · cells per tick. -1 if it would be too fast.
  int applyImpulse(Vector impulse);
  /// The same at a point of the world, which also turns it if it may turn.
  int applyImpulseAt(Vector impulse, Vector where);
  /// Turn it during the next tick; several torques add up, to ±1e30. Force · widths of a cell.
  int applyTorque(double torque);

  /// Drag: force over mass is `linear` · velocity + `quadratic` · velocity · |velocity|. Per tick, and per
  /// width of a cell; both 0 … 1e30, 0 by default.
  int setDrag(double linear, double quadratic = 0);
  /// A spring of rest length 0 to a point of the world: force over mass is `stiffness` · displacement +
  /// `damping` · velocity. Per tick² and per tick, both 0 … 1e30; 0 and 0: none.
  int setSpring(Vector anchor, double stiffness, double damping = 0);
  /// A field around `origin` (cells). Null: none. The field must outlive the body or its next setField().
  int setField(const Field* p_field, Vector origin = Vector());

  /// Is it in quarantine, because its motion has no finite solution (a field's singularity, say)? It stands
  /// until its position or velocity is set.
  bool isFrozen() const;

  // How it appears, unless its class has a draw() of its own: its shape, in character cells, at its angle.

  /// As an outline (the default), filled, or not at all. `ch`: of what characters; 0: by the direction of the
  /// edge, and # for a filling. Return 0, else -1.
  int setDrawing(BodyDrawing drawing, char32_t ch = 0, Color color = COLOR_DEFAULT);
  /// As a sprite that turns with it: rows (UTF-8) of up to 128 characters around the position; blanks are
  /// holes. Return 0, else -1.
  int setDrawing(const std::vector<std::string>& rows, Color color = COLOR_DEFAULT);
  /// A constant spin is sent to clients once, as a constant velocity is.
  int draw() override;

 private:
  friend class PhysicsManager;

  naiad::physics::BodyRow& row() const;
  naiad::physics::BodyForm& form() const;
  int setShapes(std::vector<naiad::physics::ConvexShape> shapes);
  int addShape(const naiad::physics::ConvexShape& shape);
  void fitBox();
  int refuseAs(const char* what) const;
  void absorb() const;
  naiad::physics::BodyLook& look();

  std::shared_ptr<naiad::physics::BodyTable> m_table;
  std::uint32_t m_index;                             ///< in the table
  std::shared_ptr<naiad::physics::BodyLook> m_look;  ///< from the first drawing on
};

}  // namespace df
