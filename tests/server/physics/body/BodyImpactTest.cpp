// Impacts of bodies through WM.update(): problems of the laboratory (docs/physics/lab.md) that depend on how
// the ImpactWorld gets its bodies. ImpactWorldTest and ImpactPropertyTest test the others.
#include <numbers>

#include "physics/body/Field.h"
#include "tests/server/physics/BodyScene.h"
#include "tests/support/NotANumber.h"

namespace df::test {
namespace {

class BodyImpacts : public BodyScene {};

// Problem 8c. The ball that is hit flies far within the tick, to walls that were not near before.
TEST_F(BodyImpacts, GalperinsBilliardCountsTheDigitsOfPi) {
  long right = 3;
  double mass = 1;
  for (int k = 0; k <= 3; ++k, mass *= 100, right = static_cast<long>(std::numbers::pi * std::pow(10, k))) {
    Object* p_wall = wall(Vector(-1, 0), Vector(1, 1));
    auto* p_light = crate<Listener>(Vector(1.1, 0), Vector(0.1, 0.1));
    auto* p_heavy = crate(Vector(2.3, 0), Vector(0.1, 0.1), mass);
    p_light->setRestitution(1);
    p_heavy->setVelocity(perSecond(Vector(-1, 0)));
    ticks(300);
    EXPECT_EQ(p_light->notes.size(), static_cast<std::size_t>(right)) << k;
    delete p_light;
    delete p_heavy;
    delete p_wall;
  }
}

class UpperHalf : public Field {
  Vector accelerationAt(Vector displacement, Vector /*velocity*/, double /*time*/) const override {
    return displacement.y() > 8 ? Vector() : perSecondSquared(Vector(0, -10));
  }
};

// Problem 16.
TEST_F(BodyImpacts, BehavesTheSameFarAway) {
  const UpperHalf field;
  const auto run = [&](double distance) {
    const Vector origin(distance, -distance);
    Body* p_ball = ball(origin + Vector(5, 5), Vector(0.5, 0));
    p_ball->setRestitution(0.8);
    p_ball->setField(&field, origin);
    Object* p_floor = wall(origin + Vector(0, -5), Vector(50, 5));
    std::vector<Vector> path;
    for (int i = 0; i < 150; ++i) {
      ticks(1);
      path.push_back(p_ball->getDisplacementFrom(origin));
    }
    delete p_ball;
    delete p_floor;
    return path;
  };
  const std::vector<Vector> home = run(0);
  for (const double distance : {1e4, 1e6, 1e9}) EXPECT_EQ(run(distance), home) << distance;
}

// Problem 18.
TEST_F(BodyImpacts, InvalidNumbersAffectNoOtherBody) {
  const auto run = [&](int poison) {
    OwnWorld there;
    layFloor();
    auto* p_bad = poison > 0 ? crate(Vector(20, -3)) : nullptr;
    std::vector<Body*> crates;
    for (int i = 0; i < 5; ++i) crates.push_back(crate(Vector(0.1 * i, -0.6 - 1.2 * i)));
    if (poison == 1) p_bad->setVelocity(Vector(kNan, 0));
    if (poison == 2) p_bad->applyForce(Vector(1e30, 1e30));
    if (poison == 3) p_bad->setVelocity(Vector(1e7, 1e7));
    if (poison == 4) p_bad->setMass(1e-30), p_bad->applyForce(Vector(1e30, 0));
    if (poison == 5) p_bad->setMass(1e30), p_bad->applyForce(Vector(0, 1e30));
    if (poison == 6) p_bad->setSpring(Vector(1e9, 0), 1e30, 1e30);
    if (poison == 7) p_bad->setBox(Box(Vector(), 0, 0)), p_bad->setBoxShape();
    std::vector<BodyBits> bits;
    for (int tick = 0; tick < 60; ++tick) {
      there.world.update();
      for (const Body* p_crate : crates) bits.push_back(stateBits(p_crate));
    }
    return bits;
  };
  const auto right = run(0);
  for (int poison = 1; poison <= 7; ++poison) EXPECT_EQ(run(poison), right) << poison;
}

}  // namespace
}  // namespace df::test
