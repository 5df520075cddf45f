#include "physics/body/BodyFlight.h"

#include <algorithm>
#include <cmath>

#include "physics/flight/FlightDrag.h"
#include "physics/flight/FlightField.h"
#include "physics/flight/FlightSpring.h"

namespace naiad::physics {

namespace {

/// All forces on a body together, used if there is no closed formula for their combination.
class Everything : public ForceField {
 public:
  Everything(const BodyMedium& medium, Vec2 acceleration, Vec2 to_anchor, Vec2 to_field)
      : m_medium(medium), m_acceleration(acceleration), m_to_anchor(to_anchor), m_to_field(to_field) {}

  Vec2 acceleration(Vec2 displacement, Vec2 velocity, double time) const override {
    Vec2 a = m_acceleration - m_medium.spring.stiffness * (displacement - m_to_anchor) -
             damping(velocity) * velocity;
    if (m_medium.field != nullptr)
      a += m_medium.field->acceleration(displacement - m_to_field, velocity, time);
    return a;
  }
  bool jacobian(Vec2 displacement, Vec2 velocity, double time, Mat22& by_position,
                Mat22& by_velocity) const override {
    // If the field has no Jacobian, the sum has none either: finite differences of all forces are used.
    if (m_medium.field != nullptr &&
        !m_medium.field->jacobian(displacement - m_to_field, velocity, time, by_position, by_velocity)) {
      return false;
    }
    if (m_medium.field == nullptr) by_position = by_velocity = Mat22{};
    const double speed = length(velocity);
    const double q = speed > 0 ? m_medium.quadratic_drag / speed : 0;
    const double c = damping(velocity);
    by_position.xx -= m_medium.spring.stiffness;
    by_position.yy -= m_medium.spring.stiffness;
    by_velocity.xx -= c + q * velocity.x * velocity.x;
    by_velocity.xy -= q * velocity.x * velocity.y;
    by_velocity.yx -= q * velocity.x * velocity.y;
    by_velocity.yy -= c + q * velocity.y * velocity.y;
    return true;
  }

 private:
  double damping(Vec2 velocity) const {
    return m_medium.spring.damping + m_medium.linear_drag + m_medium.quadratic_drag * length(velocity);
  }

  const BodyMedium& m_medium;
  Vec2 m_acceleration;
  Vec2 m_to_anchor;  // from the body's place at the start of the tick
  Vec2 m_to_field;
};

// A spring with a rest length, plus the game's field.
class LongSpring : public ForceField {
 public:
  LongSpring(double length, Spring spring, const ForceField* p_field, Vec2 to_field)
      : m_length(length), m_spring(spring), m_p_field(p_field), m_to_field(to_field) {}

  Vec2 acceleration(Vec2 displacement, Vec2 velocity, double time) const override {
    Vec2 a;
    const double distance = length(displacement);
    if (distance > 0) {
      const Vec2 along = displacement / distance;
      const double pull =
          m_spring.stiffness * (distance - m_length) + m_spring.damping * dot(along, velocity);
      a = -pull * along;
    }
    if (m_p_field != nullptr) a += m_p_field->acceleration(displacement - m_to_field, velocity, time);
    return a;
  }

 private:
  double m_length;
  Spring m_spring;
  const ForceField* m_p_field;
  Vec2 m_to_field;  // from the spring's anchor to the field's origin
};

// True if the body moves on a straight line through the anchor, but would not pass it even without damping.
bool staysOnLine(Vec2 displacement, Vec2 velocity, Vec2 acceleration, double spring_length,
                 double stiffness) {
  const double distance = length(displacement);
  if (distance == 0 || stiffness == 0) return false;
  if (cross(displacement, velocity) != 0 || cross(displacement, acceleration) != 0) return false;
  const double pull = length(acceleration) / stiffness;
  const double swing =
      std::abs(distance - spring_length) + 2 * pull + length(velocity) / std::sqrt(stiffness);
  return swing < spring_length;
}

// Stiffness per tick² above which no integrator follows a spring with a rest length, except along a line.
constexpr double kTooStiff = 1e4;
constexpr double kStiff = 1;             // per tick²: with less stiffness, a force changes little in a tick
constexpr double kDifference = 0x1p-20;  // step of finite differences, as a fraction of a length or speed
constexpr double kLeastTurn = 1e-6;      // rad per tick: with less turning, a field is a constant force
constexpr double kMaxGrowth = 1;         // per tick: a field that damps or speeds up more is not a magnet
constexpr double kFarthestPull = 1e12;   // metric cells; less than 2^51, the limit for moving a Place

// Returns the smallest eigenvalue of the symmetric part of the matrix.
double leastOf(const Mat22& m) {
  const double mean = 0.5 * (m.xx + m.yy), across = 0.5 * (m.xy + m.yx), apart = 0.5 * (m.xx - m.yy);
  return mean - std::sqrt(apart * apart + across * across);
}

Mat22 differences(const Everything& force, Vec2 velocity, double time, Vec2 at_start, double scale) {
  const double step = kDifference * scale;
  const Vec2 by_x = (force.acceleration({step, 0}, velocity, time) - at_start) / step;
  const Vec2 by_y = (force.acceleration({0, step}, velocity, time) - at_start) / step;
  return {by_x.x, by_y.x, by_x.y, by_y.y};
}

}  // namespace

bool pullOf(const BodyRow& row, const BodyMedium& medium, Vec2 acceleration, double time, Pull& pull) {
  if (row.flight == FlightKind::kSpring) {
    pull = {medium.anchor, {medium.spring.stiffness, medium.spring.damping + medium.linear_drag}};
    return true;
  }
  if (row.flight != FlightKind::kField) return false;
  const Vec2 to_field = medium.field_origin - row.place;
  const Everything force(medium, acceleration, medium.anchor - row.place, to_field);
  const Vec2 at_start = force.acceleration({}, row.velocity, time);
  Mat22 by_position, by_velocity;
  if (!force.jacobian({}, row.velocity, time, by_position, by_velocity)) {
    by_position = differences(force, row.velocity, time, at_start, 1 + length(to_field));
    by_velocity = {};
  }
  const double stiffness = -leastOf(by_position), damping = std::max(-leastOf(by_velocity), 0.0);
  if (!(stiffness > kStiff && stiffness < 1e30 && damping < 1e30)) return false;
  const Vec2 away = ((at_start - acceleration) + damping * row.velocity) / stiffness;
  if (!(std::fabs(away.x) < kFarthestPull && std::fabs(away.y) < kFarthestPull)) return false;
  pull = {row.place + away, {stiffness, damping}};
  return true;
}

bool magnetOf(const BodyRow& row, const BodyMedium& medium, Vec2 acceleration, double time, Magnet& magnet) {
  if (row.flight != FlightKind::kField) return false;
  const Everything force(medium, acceleration, medium.anchor - row.place, medium.field_origin - row.place);
  const Turning turning = turningAt(force, {}, row.velocity, time);
  const double rate = turning.lambda.y, growth = turning.lambda.x;
  if (!(std::fabs(rate) > kLeastTurn && std::fabs(rate) < 1e30 && std::fabs(growth) < kMaxGrowth))
    return false;
  magnet = {rate, turning.rest + growth * row.velocity};
  return isFinite(magnet.rest);
}

Joint jointOf(const Pull& pull, double mass) {
  constexpr double kMaxNumber = 1e30;  // limit of all numbers of a joint
  Joint joint;
  joint.kind = JointKind::kMouse;
  joint.target = pull.to;
  joint.stiffness = std::min(mass * pull.spring.stiffness, kMaxNumber);
  joint.damping = std::min(mass * pull.spring.damping, kMaxNumber);
  return joint;
}

IntegratorStatus flyHanging(const BodyRow& row, const BodyMedium& medium, const Joint& spring, Place anchor,
                            Vec2 acceleration, double time, const IntegratorOptions& options, Flown& flown,
                            IntegratorCounters& counters) {
  const Spring own = {row.inverse_mass * spring.stiffness, row.inverse_mass * spring.damping};
  const Vec2 displacement = row.place - anchor;
  const bool is_plain = row.flight == FlightKind::kFree || row.flight == FlightKind::kLinearDrag;
  const bool is_linear = spring.length == 0 ||
                         staysOnLine(displacement, row.velocity, acceleration, spring.length, own.stiffness);
  if (is_plain && is_linear) {
    const Vec2 rest = spring.length == 0 ? Vec2{} : (spring.length / length(displacement)) * displacement;
    flown = flySpring(displacement - rest, row.velocity, acceleration,
                      {own.stiffness, own.damping + medium.linear_drag}, 1);
    const bool finite = isFinite(flown.displacement) && isFinite(flown.velocity);
    return finite ? IntegratorStatus::kDone : IntegratorStatus::kNotFinite;
  }
  if (own.stiffness > kTooStiff) return IntegratorStatus::kTooManySteps;
  const LongSpring force(spring.length, own, medium.field, medium.field_origin - anchor);
  BodyMedium all = medium;
  all.field = &force;
  const Everything everything(all, acceleration, medium.anchor - row.place, anchor - row.place);
  return flyField(everything, Vec2{}, row.velocity, time, 1, options, flown, counters);
}

IntegratorStatus flyBody(const BodyRow& row, const BodyMedium& medium, Vec2 acceleration, double time,
                         double t, const IntegratorOptions& options, Flown& flown,
                         IntegratorCounters& counters) {
  switch (row.flight) {
    case FlightKind::kFree:
      flown = flyFree(row.velocity, acceleration, t);
      break;
    case FlightKind::kLinearDrag:
    case FlightKind::kSpring: {
      const Spring spring{medium.spring.stiffness, medium.spring.damping + medium.linear_drag};
      flown = flySpring(row.place - medium.anchor, row.velocity, acceleration, spring, t);
      break;
    }
    case FlightKind::kQuadraticDrag:
      return flyQuadraticDrag(row.velocity, acceleration, medium.quadratic_drag, t, flown, counters);
    case FlightKind::kField: {
      const Everything everything(medium, acceleration, medium.anchor - row.place,
                                  medium.field_origin - row.place);
      return flyField(everything, Vec2{}, row.velocity, time, t, options, flown, counters);
    }
  }
  const bool finite = isFinite(flown.displacement) && isFinite(flown.velocity);
  return finite ? IntegratorStatus::kDone : IntegratorStatus::kNotFinite;
}

}  // namespace naiad::physics
