// Impacts of bodies through WM.update(): those problems of the laboratory (docs/physics/lab.md) that have no
// rotation. Their targets are the bounds.
#include <bit>
#include <cstdint>
#include <numbers>

#include "physics/body/Field.h"
#include "shared/values/SplitMix64.h"
#include "tests/server/physics/BodyScene.h"
#include "tests/support/NotANumber.h"

namespace df::test {
namespace {

class BodyImpacts : public BodyScene {};

// Problem 7.
TEST_F(BodyImpacts, BouncingBallFollowsRestitutionAndComesToRest) {
  layFloor();
  Body* p_ball = ball(Vector(0, -10.5), Vector());
  p_ball->setRestitution(0.8);
  const auto apex = [&] { return -p_ball->getPosition().y() - 0.5 + std::pow(speedOf(p_ball).y(), 2) / 20; };
  double right = 10;
  int bounces = 0, last_moving = 0;
  double before = 0;
  for (int tick = 1; tick <= 450; ++tick) {
    ticks(1);
    const double speed = speedOf(p_ball).y();
    if (speed < 0 && before >= 0 && ++bounces <= 3) {
      right *= 0.64;
      EXPECT_NEAR(apex() / right, 1, 1e-9) << bounces;
    }
    before = speed;
    if (std::abs(speed) > 1e-3) last_moving = tick;
  }
  EXPECT_NEAR((last_moving + 1) / 30.0, std::sqrt(2) * 9, 1 / 30.0);
  EXPECT_EQ(p_ball->getVelocity(), Vector());
  EXPECT_EQ(static_cast<Object*>(p_ball)->getAcceleration(), Vector());
}

// Problem 8.
TEST_F(BodyImpacts, CradlePassesOnTheImpulse) {
  std::vector<Body*> balls;
  for (int i = 0; i < 5; ++i) balls.push_back(ball(Vector(i == 0 ? -2 : i, 0), Vector(i == 0 ? 5 : 0, 0)));
  ticks(60);
  for (int i = 0; i < 5; ++i) EXPECT_NEAR(speedOf(balls[i]).x(), i == 4 ? 5 : 0, 1e-9) << i;
}

// Problem 8b.
TEST_F(BodyImpacts, ObliqueImpactActsAlongTheLineOfCentres) {
  for (const double speed : {5.0, 50.0}) {
    for (int i = 0; i < 24; ++i) {
      const double offset = (i + 0.5) / 24 * 0.98, y = 32.0 * i;
      Body* p_shot = ball(Vector(0, y + offset), Vector(speed, 0));
      Body* p_struck = ball(Vector(2.5, y), Vector());
      ticks(static_cast<int>(std::ceil(2.6 / speed * 30)) + 2);
      const Vector normal(std::sqrt(1 - offset * offset), -offset);
      EXPECT_NEAR(speedOf(p_struck).x() / speed, normal.x() * normal.x(), 1e-9) << offset;
      EXPECT_NEAR(speedOf(p_struck).y() / speed, normal.x() * normal.y(), 1e-9) << offset;
      delete p_shot;
      delete p_struck;
    }
  }
}

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

// Problems 9 and 10, but without rotation.
TEST_F(BodyImpacts, StackedCratesStayInPlace) {
  layFloor(100);
  const auto stands = [&](const std::vector<double>& masses) {
    std::vector<Body*> crates;
    for (std::size_t i = 0; i < masses.size(); ++i) {
      crates.push_back(crate(Vector(0, -0.5 - static_cast<double>(i)), Vector(0.5, 0.5), masses[i]));
    }
    double worst = 0;
    for (int tick = 0; tick < 300; ++tick) {
      ticks(1);
      for (std::size_t i = 0; i < crates.size(); ++i) {
        worst = std::max(worst, std::abs(crates[i]->getPosition().y() + 0.5 + static_cast<double>(i)));
        worst = std::max(worst, std::abs(crates[i]->getPosition().x()));
      }
    }
    for (Body* p_crate : crates) delete p_crate;
    return worst;
  };
  for (const std::size_t n : {10u, 30u, 100u}) EXPECT_LE(stands(std::vector<double>(n, 1)), 1e-9) << n;
  for (const double ratio : {10.0, 100.0, 1e3, 1e4, 1e6}) EXPECT_LE(stands({1, ratio}), 1e-9) << ratio;
}

// Problem 12. The direction of gravity is tilted instead of the slope.
TEST_F(BodyImpacts, FrictionHoldsUpToItsAngleAndSlidesBeyond) {
  wall(Vector(0, 5), Vector(200, 5));
  const auto slides = [&](double angle, int n) {
    PM.setGravity(perSecondSquared(Vector(10 * std::sin(angle), 10 * std::cos(angle))));
    Body* p_crate = crate(Vector(0, -0.25), Vector(0.5, 0.25));
    ticks(n);
    const double displacement = p_crate->getPosition().x();
    delete p_crate;
    return displacement;
  };
  const double threshold = std::atan(0.5), hundredth = 0.01 * std::numbers::pi / 180;
  EXPECT_EQ(slides(threshold - hundredth, 120), 0);
  EXPECT_GT(slides(threshold + hundredth, 120), 1e-3);
  const double steep = 40 * std::numbers::pi / 180;
  EXPECT_NEAR(slides(steep, 60) / (20 * (std::sin(steep) - 0.5 * std::cos(steep))), 1, 1e-9);
  PM.setGravity(perSecondSquared(Vector(0, 10)));
  Body* p_crate = crate(Vector(0, -0.25), Vector(0.5, 0.25));
  p_crate->setVelocity(perSecond(Vector(10, 0)));
  ticks(90);
  EXPECT_NEAR(p_crate->getPosition().x() / 10, 1, 1e-9);
  EXPECT_EQ(p_crate->getVelocity(), Vector());
}

// A part of problem 14.
TEST_F(BodyImpacts, FastBodiesDoNotTunnel) {
  naiad::SplitMix64 random(14);
  for (int i = 0; i < 2000; ++i) {
    const int pair = i % 4;
    const double speed = 10 * std::pow(1e5, random.unit()), aside = 2 * random.unit() - 1;
    const double closing = pair == 1 ? 1.5 * speed : pair == 3 ? 2 * speed : speed;
    const double reach = pair == 3 ? 0.5 : 0.35;
    const double start = -reach - closing * 2 * random.unit() / 30;
    Object* p_target = nullptr;
    if (pair == 0) p_target = wall(Vector(0, 0), Vector(0.1, 2));
    if (pair == 1 || pair == 2) p_target = crate(Vector(0, 0), Vector(0.1, 2));
    if (pair == 3) p_target = ball(Vector(0, 0), Vector(-speed, 0), 0.25);
    auto* p_shot = ball<Listener>(Vector(start, pair == 3 ? 0.25 * aside : aside), Vector(speed, 0), 0.25);
    if (pair == 1) {
      static_cast<Body*>(p_target)->setKinematic();
      static_cast<Body*>(p_target)->setVelocity(perSecond(Vector(-speed / 2, 0)));
    }
    ticks(4);
    ASSERT_LT(p_shot->getPosition().x(), p_target->getPosition().x()) << i;
    ASSERT_FALSE(p_shot->notes.empty()) << i;
    delete p_shot;
    delete p_target;
  }
}

// Problem 15.
TEST_F(BodyImpacts, BounceUsesTheRestOfTheTick) {
  const double gap = 2.3 / 30 * 200;
  Body* p_ball = ball(Vector(0, 0), Vector(200, 0));
  wall(Vector(gap + 1.5, 0), Vector(1, 10));
  ticks(4);
  EXPECT_NEAR(p_ball->getPosition().x(), 2 * gap - 200 * 4 / 30.0, 1e-9);
  EXPECT_EQ(p_ball->getPosition().y(), 0);
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

// Problem 17, but without rotation.
TEST_F(BodyImpacts, AClosedSystemKeepsItsMomentum) {
  naiad::SplitMix64 random(17);
  std::vector<Body*> discs;
  for (int i = 0; i < 100; ++i) {
    const Vector place(1.5 * (i % 10) - 6.75, 1.5 * (i / 10) - 6.75);
    const double dx = random.unit() - 0.3, dy = random.unit() - 0.5;
    Body* p_disc = ball(place, Vector(-0.3 * place.x() + dx, -0.3 * place.y() + dy));
    p_disc->setRestitution(0.5);
    p_disc->setFriction(0.5);
    discs.push_back(p_disc);
  }
  const auto momentum = [&](double& size, double& energy) {
    Vector sum;
    size = energy = 0;
    for (const Body* p_disc : discs) {
      const Vector v = p_disc->getVelocity();
      sum = sum + v;
      size += std::hypot(v.x(), v.y());
      energy += v.x() * v.x() + v.y() * v.y();
    }
    return sum;
  };
  double size = 0, energy = 0, ignored = 0, now = 0;
  const Vector start = momentum(size, energy);
  for (int i = 0; i < 1000; ++i) {
    ticks(1);
    const Vector sum = momentum(ignored, now);
    ASSERT_LE(std::hypot(sum.x() - start.x(), sum.y() - start.y()) / size, 1e-12) << i;
    ASSERT_LE(now, energy * (1 + 1e-12)) << i;
  }
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
    std::vector<std::uint64_t> bits;
    for (int tick = 0; tick < 60; ++tick) {
      there.world.update();
      for (const Body* p_crate : crates) {
        for (const double number : {p_crate->getPosition().x(), p_crate->getPosition().y(),
                                    p_crate->getVelocity().x(), p_crate->getVelocity().y()}) {
          bits.push_back(std::bit_cast<std::uint64_t>(number));
        }
      }
    }
    return bits;
  };
  const auto right = run(0);
  for (int poison = 1; poison <= 7; ++poison) EXPECT_EQ(run(poison), right) << poison;
}

}  // namespace
}  // namespace df::test
