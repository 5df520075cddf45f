// An Object with mass: forces move it, by Newton's laws instead of the book's steps.
//
//   class Ball : public df::Body {
//    public:
//     Ball() { setMass(2); setVelocity(df::Vector(0.5, -1)); }
//   };
//   PM.setGravity(df::Vector(0, 0.02));
//
// Within a tick a body's path is exact where mathematics has a formula for it (docs/physics/flight.md), so no
// step is too long. HARD bodies hit, rest on and slide along each other and HARD Objects; SOFT ones hear of
// contacts and push nobody; SPECTRAL ones touch nothing (docs/physics/bodies.md). Units: cells, ticks, and a
// mass of the game's choosing; Seconds.h converts. All the rest of an Object works as ever; a velocity or a
// position that is set from outside is taken over in the next tick.
//
// Setters return 0, or -1 for numbers that are not finite or out of range: then nothing changes, and the
// world counts it (World::getRefusals).
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "ConvexShape.h"
#include "Object.h"
#include "Vector.h"
#include "detail/BodyDrawing.h"

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

  /// 1e-30 … 1e30.
  int setMass(double mass);
  double getMass() const;
  /// How much of the world's gravity it feels; 1 by default, 0: none. Any finite number to ±1e30.
  int setGravityScale(double scale);
  double getGravityScale() const;
  /// Nothing pushes or slows it, gravity neither: it goes on as its velocity and spin say, like a lift or a
  /// mill. Off by default.
  void setKinematic(bool kinematic = true);
  bool isKinematic() const;

  // How it touches.

  /// How much of the speed of an impact is left, 0 (clay, the default) … 1 (nothing is lost). Of two bodies
  /// the larger number counts.
  int setRestitution(double restitution);
  double getRestitution() const;
  /// Coulomb's µ, 0 (ice) … 1e30; 0.5 by default. Of two bodies the geometric mean counts.
  int setFriction(double friction);
  double getFriction() const;
  /// Have this body (and no other for that) hear when contacts end, by an EventContactEnd. Off by default.
  void setContactEnds(bool contact_ends = true);
  bool hasContactEnds() const;

  // Its shape: the Object's box, unless one of these says otherwise. Each of them also fits the Object's box
  // around the shape. Lengths are in cells, as positions are, but a radius is in widths of a cell.

  /// The Object's own box again, whatever setBox() makes of it; its middle need not be the position.
  int setBoxShape();
  /// A box of this size around the position. Unlike setBox(), it turns with the body.
  int setBoxShape(double width, double height);
  /// A circle around the position, as round as a cell's aspect lets it look.
  int setCircle(double radius);
  /// A convex polygon of 3 to 16 corners, in order either way round, moved so that the position is its centre
  /// of mass.
  int setPolygon(const std::vector<Vector>& corners);
  /// One more part, so that the body is a compound. `centre` and `corners` count from the centre of mass of
  /// what was there; then all is moved so that the position is the centre of mass of the whole.
  int addCircle(double radius, Vector centre);
  int addBoxShape(double width, double height, Vector centre, double angle = 0);
  int addPolygon(const std::vector<Vector>& corners);
  /// What it consists of, about the position and not turned; empty: the Object's box. For who draws it.
  const std::vector<naiad::physics::ConvexShape>& getShapes() const;

  // How it turns. Angles are in radians, clockwise on the screen.

  /// May it turn? Off by default: then nothing turns it but a spin that the game sets. Its moment of inertia
  /// is that of its shape, evenly filled with its mass.
  void setTurning(bool turning = true);
  bool isTurning() const;
  /// Any finite angle to ±1e6; what getAngle() says lies in [−π, π].
  int setAngle(double angle);
  double getAngle() const;
  /// Radians per tick, to ±1e6.
  int setSpin(double spin);
  double getSpin() const;
  /// Mass · (widths of a cell)².
  double getInertia() const;

  /// All digits of what the body's position and velocity are, where Object's are rounded to 2^-32 cell.
  int setPosition(Vector position) override;
  Vector getPosition() const;
  /// The way from a point of the world to the position: all digits, also where a coordinate has none left.
  Vector getWayFrom(Vector point) const;
  int setVelocity(Vector velocity);
  Vector getVelocity() const;

  /// Push it during the next tick; several pushes add up. Mass · cells per tick².
  int applyForce(Vector force);
  /// Change its velocity at once, by impulse / mass. Mass · cells per tick.
  int applyImpulse(Vector impulse);
  /// The same at a point of the world, which also turns it if it may turn.
  int applyImpulseAt(Vector impulse, Vector where);
  /// Turn it during the next tick; several torques add up. Force · widths of a cell.
  int applyTorque(double torque);

  /// The air: force over mass is `linear` · velocity + `quadratic` · velocity · |velocity|. Both >= 0; per
  /// tick, and per metric cell.
  int setDrag(double linear, double quadratic = 0);
  /// A spring of rest length 0 to a point of the world: force over mass is `stiffness` · way + `damping` ·
  /// velocity. Per tick² and per tick, both >= 0, as stiff as you like; 0 and 0: none.
  int setSpring(Vector anchor, double stiffness, double damping = 0);
  /// A field around `origin`. Null: none. It must outlive the body or its next setField().
  int setField(const Field* p_field, Vector origin = Vector());

  /// Its motion could not be worked out (a field that is not finite, say): it stands until its position or
  /// velocity is set.
  bool isFrozen() const;

  // How it appears, unless its class has a draw() of its own: its shape, in character cells, at its angle.

  /// As an outline (the default), filled, or not at all. `ch`: of what characters; 0: by the direction of the
  /// edge, and # for a filling. Return 0, else -1.
  int setDrawing(BodyDrawing drawing, char32_t ch = 0, Color color = COLOR_DEFAULT);
  /// As a sprite that turns with it: rows (UTF-8) of up to 128 characters around the position; blanks are
  /// holes. Return 0, else -1.
  int setDrawing(const std::vector<std::string>& rows, Color color = COLOR_DEFAULT);
  /// What turns evenly, however fast, is told to watchers once, as what flies straight is.
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
