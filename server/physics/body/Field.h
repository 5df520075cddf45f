// A field of force that a game defines: gravity towards a planet, wind, a magnet.
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

/// Body::setField() puts a body into it. It must outlive the bodies in it.
class Field {
 public:
  Field();
  Field(const Field&) = delete;
  Field& operator=(const Field&) = delete;
  virtual ~Field();

  /// The acceleration of a body, in widths of a cell per tick². `displacement` is from the field's origin to
  /// the body, in widths of a cell both ways (a row of cells is PM.getAspect() of them high); `velocity` is
  /// in the same per tick; `time` is in ticks since the world's first. It must be a pure function of these:
  /// it is called several times per tick, and for states that the body never reaches. A body whose
  /// acceleration is not finite is frozen (Body::isFrozen).
  virtual Vector accelerationAt(Vector displacement, Vector velocity, double time) const = 0;

 private:
  friend class Body;
  std::unique_ptr<naiad::physics::ForceField> m_forces;  ///< the same for the integrators
};

}  // namespace df
