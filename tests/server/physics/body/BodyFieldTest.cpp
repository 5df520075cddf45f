// Force fields of any stiffness: their cost, and how well the energy is conserved.
#include <cmath>
#include <cstdint>

#include "tests/server/physics/BodyScene.h"

namespace df::test {
namespace {

class BodyFields : public BodyScene {};

// A field by `kind`: proportional to the distance, to its third power, or van der Pol's field, which is
// smooth, then stiff, then jumps within a tick.
FieldOf fieldOf(int kind, double stiffness) {
  return FieldOf([kind, stiffness](Vector d, Vector v) {
    const double x = d.x();
    if (kind == 0) return Vector(-stiffness * x, 0);
    if (kind == 1) return Vector(-stiffness * x * x * x, 0);
    return Vector(stiffness * (900 * (1 - x * x) * v.x() / 30 - x) / 900, 0);
  });
}

// The number of calls per tick is limited at any stiffness and number of bodies: for a body in the air, a
// body that is about to touch a floor, and a hundred bodies.
TEST_F(BodyFields, FieldCallsPerTickAreBounded) {
  wall(Vector(0, 0.5), Vector(50, 0.5));
  for (const int count : {1, 100}) {
    for (const int kind : {0, 1, 2}) {
      for (const double k : {1.0, 1e4, 1e6, 1e12}) {
        FieldOf field = fieldOf(kind, k);
        std::vector<Body*> bodies;
        for (int i = 0; i < count; ++i) {
          Body* p_body = crate(Vector(2 - 0.001 * i, i == 0 ? -0.5 : -2.0 * i));
          bodies.push_back(p_body);
          p_body->setTurning();
          p_body->setField(&field, Vector(0, -0.5));
        }
        const std::int64_t most = kind == 0 ? 700 * count : 18'000 + 450 * count;
        for (int i = 0; i < 30; ++i) {
          field.calls = 0;
          ticks(1);
          ASSERT_LE(field.calls, most) << count << ' ' << kind << ' ' << k << ' ' << i;
        }
        for (Body* p_body : bodies) {
          EXPECT_FALSE(p_body->isFrozen()) << count << ' ' << kind << ' ' << k;
          EXPECT_LE(std::abs(p_body->getPosition().x()), 3) << count << ' ' << kind << ' ' << k;
          delete p_body;
        }
      }
    }
  }
}

// A body in a linear field oscillates without loss at any stiffness, because it moves by a formula.
TEST_F(BodyFields, StiffFieldKeepsEnergyInFlight) {
  for (const double k : {1.0, 1e3, 1e4, 1e6, 1e10}) {
    const FieldOf field = fieldOf(0, k);
    Body* p_ball = ball(Vector(1, 0), Vector());
    p_ball->setField(&field);
    PM.setGravity(Vector(0, 0.001));
    for (int i = 0; i < 300; ++i) {
      ticks(1);
      const double x = p_ball->getPosition().x(), v = p_ball->getVelocity().x();
      ASSERT_NEAR((v * v + k * x * x) / k, 1, 1e-8) << k << ' ' << i;
      const double fallen = 0.5 * 0.001 * (i + 1) * (i + 1);
      ASSERT_NEAR(p_ball->getPosition().y(), fallen, 1e-8 * fallen) << k << ' ' << i;
    }
    delete p_ball;
  }
}

// The force is constant on both sides of x = 0 and changes its sign within a fiftieth of a cell. No body
// freezes, in the air and on a floor. In the air, none swings farther than from where it started.
TEST_F(BodyFields, SwitchedForceHoldsABodyAtAnyStrength) {
  for (const Accuracy accuracy : {ACCURACY_DEFAULT, ACCURACY_FAST}) {
    for (double strength = 1; strength <= 1e12; strength *= 10) {
      OwnWorld own(1, Vector(), accuracy);
      layFloor();
      const FieldOf field(
          [strength](Vector d, Vector /*velocity*/) { return Vector(-strength * std::tanh(50 * d.x()), 0); });
      Body* const bodies[] = {ball(Vector(1, -20), Vector()), crate(Vector(1, -0.5)),
                              turningCrate(Vector(1, -0.5))};
      bodies[0]->setGravityScale(0);
      bodies[2]->setPosition(Vector(1, -4));
      for (Body* p_body : bodies) p_body->setField(&field);
      for (int i = 0; i < 20; ++i) {
        field.calls = 0;
        own.world.update();
        ASSERT_LE(field.calls, 30'000) << strength << ' ' << i;
      }
      for (const Body* p_body : bodies) {
        EXPECT_FALSE(p_body->isFrozen()) << accuracy << ' ' << strength;
      }
      EXPECT_LE(std::fabs(bodies[0]->getPosition().x()), 1.001) << accuracy << ' ' << strength;
    }
  }
}

}  // namespace
}  // namespace df::test
