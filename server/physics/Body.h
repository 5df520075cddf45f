// An Object with mass: forces move it, by Newton's laws instead of the book's steps.
//
//   class Ball : public df::Body {
//    public:
//     Ball() { setMass(2); setVelocity(df::Vector(0.5, -1)); }
//   };
//   PM.setGravity(df::Vector(0, 0.02));
//
// Within a tick a body's path is exact where mathematics has a formula for it (docs/physics/flight.md), so no
// step is too long. Units: cells, ticks, and a mass of the game's choosing; Seconds.h converts. All the rest
// of an Object works as ever; a velocity or a position that is set from outside is taken over in the next
// tick.
//
// Setters return 0, or -1 for numbers that are not finite or out of range: then nothing changes, and the
// world counts it (World::getRefusals).
#pragma once

#include <cstdint>
#include <memory>

#include "Object.h"
#include "Vector.h"

namespace naiad::physics {
class BodyTable;
struct BodyRow;
}  // namespace naiad::physics

namespace df {

class Field;

class Body : public Object {
 public:
  /// An Object of mass 1 in the current world.
  Body();
  ~Body() override;

  /// 1e-30 … 1e30.
  int setMass(double mass);
  double getMass() const;
  /// How much of the world's gravity it feels; 1 by default, 0: none. Any finite number to ±1e30.
  int setGravityScale(double scale);
  double getGravityScale() const;

  /// All digits of what the body's position and velocity are, where Object's are rounded to 2^-32 cell.
  int setPosition(Vector position);
  Vector getPosition() const;
  int setVelocity(Vector velocity);
  Vector getVelocity() const;

  /// Push it during the next tick; several pushes add up. Mass · cells per tick².
  int applyForce(Vector force);
  /// Change its velocity at once, by impulse / mass. Mass · cells per tick.
  int applyImpulse(Vector impulse);

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

 private:
  naiad::physics::BodyRow& row() const;
  int refuseAs(const char* what) const;
  void absorb() const;

  std::shared_ptr<naiad::physics::BodyTable> m_table;
  std::uint32_t m_index;  ///< in the table
};

}  // namespace df
