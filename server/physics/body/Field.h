// A force field defined by a game: gravity towards a planet, wind, a magnet.
//
//   class Planet : public df::Field {
//     df::Vector accelerationAt(df::Vector d, df::Vector, double) const override {
//       const double r = std::hypot(d.x(), d.y());
//       return df::Vector(-d.x() / (r * r * r), -d.y() / (r * r * r));
//     }
//   };
#pragma once

#include <memory>

#include "Vector.h"

namespace naiad::physics {
class ForceField;
}

namespace df {

/// Body::setField() puts a body into the field. The field must outlive the bodies in it.
class Field {
 public:
  Field();
  Field(const Field&) = delete;
  Field& operator=(const Field&) = delete;
  virtual ~Field();

  /// Returns the acceleration of a body, in cell widths per tick². `displacement` is from the field's origin
  /// to the body, in cell widths along both axes (a row of cells is PM.getAspect() cell widths high).
  /// `velocity` is in cell widths per tick, `time` in ticks since the first use of physics in the world. Must
  /// be a pure function of these arguments: it is called several times per tick, also for states that the
  /// body never reaches. A body whose acceleration is not finite is frozen (Body::isFrozen).
  virtual Vector accelerationAt(Vector displacement, Vector velocity, double time) const = 0;

 private:
  friend class Body;
  std::unique_ptr<naiad::physics::ForceField> m_forces;  ///< adapter for the integrators
};

}  // namespace df
