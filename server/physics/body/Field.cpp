#include "physics/body/Field.h"

#include "physics/flight/FlightField.h"

namespace df {

namespace {

using naiad::physics::Vec2;

class FieldForces : public naiad::physics::ForceField {
 public:
  explicit FieldForces(const Field& field) : m_field(field) {}
  Vec2 acceleration(Vec2 displacement, Vec2 velocity, double time) const override {
    const Vector a = m_field.accelerationAt({displacement.x, displacement.y}, {velocity.x, velocity.y}, time);
    return {a.x(), a.y()};
  }

 private:
  const Field& m_field;
};

}  // namespace

Field::Field() : m_forces(std::make_unique<FieldForces>(*this)) {}

Field::~Field() = default;

}  // namespace df
