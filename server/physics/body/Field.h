// A field of force that a game defines: gravity towards a planet, wind, a magnet.
//
//   class Planet : public df::Field {
//     df::Vector accelerationAt(df::Vector way, df::Vector, double) const override {
//       const double r = std::hypot(way.x(), way.y());
//       return df::Vector(-way.x() / (r * r * r), -way.y() / (r * r * r));
//     }
//   };
#pragma once

#include "Metric.h"
#include "Vector.h"
#include "detail/FlightField.h"

namespace df {

/// A body is told of it by Body::setField(). It must outlive the bodies in it.
class Field {
 public:
  Field() = default;
  Field(const Field&) = delete;
  Field& operator=(const Field&) = delete;
  virtual ~Field() = default;

  /// What it does to a body, in metric cells per tick² (Metric.h: y counts as much as x): of its place
  /// relative to the field's origin and its velocity, metric as well, and of the time in ticks. A pure
  /// function of these: it is called several times per tick, and for states that the body never reaches.
  virtual Vector accelerationAt(Vector way, Vector velocity, double time) const = 0;

  /// The same for the integrators.
  const naiad::physics::ForceField& forces() const { return m_forces; }

 private:
  class Forces : public naiad::physics::ForceField {
   public:
    explicit Forces(const Field& field) : m_field(field) {}
    naiad::physics::Vec2 acceleration(naiad::physics::Vec2 way, naiad::physics::Vec2 velocity,
                                      double time) const override {
      const Vector a = m_field.accelerationAt({way.x, way.y}, {velocity.x, velocity.y}, time);
      return {a.x(), a.y()};
    }

   private:
    const Field& m_field;
  };
  Forces m_forces{*this};
};

}  // namespace df
