// Scenes that failed once: bodies that meet at a point, touching blocks, springs of any stiffness on held
// bodies, nets, leaning stacks, crowds. No body is frozen or gains energy, and the work is limited.
#include <algorithm>
#include <array>
#include <numbers>

#include "shared/values/SplitMix64.h"
#include "tests/server/physics/BodyScene.h"

namespace df::test {
namespace {

constexpr double kFall = 10;  // cells per second²

class BodyScenes : public BodyScene {
 protected:
  Body* put(Body* p_body) {
    bodies.push_back(p_body);
    return p_body;
  }
  double kinetic() const {
    double sum = 0;
    for (const Body* p_body : bodies) sum += kineticOf(p_body);
    return sum;
  }
  void deleteBodies() {
    for (Body* p_body : bodies) delete p_body;
    bodies.clear();
  }
  Vector momentum() const {
    Vector sum;
    for (const Body* p_body : bodies) {
      const Vector v = p_body->getVelocity();
      sum = sum + Vector(p_body->getMass() * v.x(), p_body->getMass() * v.y());
    }
    return sum;
  }
  // Checks a closed system: energy does not grow, momentum is constant, and nothing is frozen.
  void expectClosed(int count, double tolerance) {
    const Vector start = momentum();
    double least = kinetic(), size = 0;
    for (const Body* p_body : bodies) {
      size += p_body->getMass() * std::hypot(p_body->getVelocity().x(), p_body->getVelocity().y());
    }
    for (int i = 0; i < count; ++i) {
      ticks(1);
      const Vector now = momentum();
      ASSERT_LE(std::hypot(now.x() - start.x(), now.y() - start.y()), tolerance * size) << i;
      ASSERT_LE(kinetic(), least * (1 + 1e-9)) << i;
      least = kinetic();
    }
    EXPECT_EQ(PM.getQuarantineCount(), 0U);
  }

  std::vector<Body*> bodies;
};

TEST_F(BodyScenes, FourBodiesMeetingAtAPointNeedFewImpacts) {
  for (const double x : {-3, 3}) {
    for (const double y : {-3, 3}) {
      put(crate(Vector(x, y)))->setVelocity(Vector(x > 0 ? -0.1 : 0.1, y > 0 ? -0.1 : 0.1));
    }
  }
  expectClosed(60, 1e-12);
  EXPECT_LE(layer().impactCounters().impacts, 20);
}

TEST_F(BodyScenes, RingMeetingAtAPointKeepsItsMomentum) {
  constexpr int kCount = 60;
  for (int i = 0; i < kCount; ++i) {
    const double angle = 2 * std::numbers::pi * i / kCount;
    const Vector out(std::cos(angle), std::sin(angle));
    put(crate(Vector(20 * out.x(), 20 * out.y())))->setVelocity(Vector(-0.1 * out.x(), -0.1 * out.y()));
  }
  expectClosed(250, 1e-12);
}

TEST_F(BodyScenes, TouchingBlocksKeepMomentumWithFewImpacts) {
  for (int seed = 0; seed < 60; ++seed) {
    naiad::SplitMix64 random(static_cast<std::uint64_t>(seed));
    const int side = 2 + seed % 2;
    for (int i = 0; i < side * side; ++i) {
      const double vx = 0.04 * (random.unit() - 0.5), vy = 0.04 * (random.unit() - 0.5);
      put(crate(Vector(i % side, i / side)))->setVelocity(Vector(vx, vy));
    }
    const std::int64_t before = layer().impactCounters().impacts;
    ASSERT_NO_FATAL_FAILURE(expectClosed(60, 1e-9)) << seed;
    EXPECT_LE(layer().impactCounters().impacts - before, 1000) << seed;
    deleteBodies();
  }
}

// The group exceeds the limit of work, so it moves as a whole in soft sub-steps. Begin and end events of each
// pair still alternate.
TEST_F(BodyScenes, GroupOverTheImpactLimitMovesInSubsteps) {
  for (const double side : {-1, 1}) {
    wall(Vector(side * 5.5, 0), Vector(0.5, 6));
    wall(Vector(0, side * 5.5), Vector(6, 0.5));
  }
  std::vector<Listener*> balls;
  for (int i = 0; i < 100; ++i) {
    Listener* p_ball = ball<Listener>(Vector(i % 10 - 4.5, i / 10 - 4.5), Vector(), 0.4);
    p_ball->setVelocity(Vector(20.0 * (i % 7) - 60, 20.0 * (i % 11) - 100));
    p_ball->setContactEnds();
    balls.push_back(p_ball);
    put(p_ball);
  }
  const double start = kinetic();
  ticks(20);
  EXPECT_GT(layer().impactCounters().given_up, 0);
  EXPECT_GT(layer().substepCounters().ticks, 0);
  EXPECT_LE(kinetic(), start * (1 + 1e-9));
  EXPECT_EQ(PM.getQuarantineCount(), 0U);
  for (const Listener* p_ball : balls) {
    p_ball->expectTurns();
    EXPECT_LT(std::abs(p_ball->getPosition().x()), 5.5);
    EXPECT_LT(std::abs(p_ball->getPosition().y()), 5.5);
  }
}

constexpr std::array<double, 9> kStiffnesses = {0.01, 0.1, 1, 4.5, 10, 100, 1e4, 1e8, 1e12};

// A box on ice that a spring pulls to a point: its largest distance from the point, in the whole run and at
// its end.
struct Swing {
  double farthest = 0, late = 0, gained = 0, sunk = 0;
};

class PulledBox : public BodyScenes {
 protected:
  template <class Pull>
  Swing swing(double stiffness, Pull pull) {
    Object* p_floor = wall(Vector(0, 0.5), Vector(50, 0.5));
    PM.setGravity(perSecondSquared(Vector(0, kFall)));
    Body* p_box = turningCrate(Vector(1, -0.5));
    p_box->setFriction(0);
    pull(p_box);
    const auto energy = [&] {
      const double x = p_box->getPosition().x(), v = p_box->getVelocity().x();
      return 0.5 * v * v + 0.5 * stiffness * x * x;
    };
    const double start = energy();
    Swing swing;
    for (int i = 0; i < 300; ++i) {
      ticks(1);
      const double away = std::abs(p_box->getPosition().x());
      swing.farthest = std::max(swing.farthest, away);
      if (i >= 200) swing.late = std::max(swing.late, away);
      swing.gained = std::max(swing.gained, energy() / start - 1);
      swing.sunk = std::max(swing.sunk, std::abs(p_box->getPosition().y() + 0.5));
      // If it is stiffer, one unit in the last place of a position is a force that throws the box.
      if (stiffness <= 1e8) {
        EXPECT_NEAR(p_box->getPosition().y(), -0.5, 5e-3) << stiffness << ' ' << i;
      }
      EXPECT_LT(p_box->getPosition().y(), -0.4) << stiffness << ' ' << i;
    }
    EXPECT_FALSE(p_box->isFrozen()) << stiffness;
    delete p_box;
    delete p_floor;
    return swing;
  }
};

TEST_F(PulledBox, SpringsAndFieldsAreBoundedAtAnyStiffness) {
  for (const double k : kStiffnesses) {
    const FieldOf field([k](Vector d, Vector /*velocity*/) { return Vector(-k * d.x(), -k * d.y()); });
    for (const bool is_field : {false, true}) {
      const Swing its = swing(k, [&](Body* p_box) {
        is_field ? p_box->setField(&field, Vector(0, -0.5)) : p_box->setSpring(Vector(0, -0.5), k);
      });
      const double most = is_field ? 1e-6 : 1e-5;
      EXPECT_LE(its.gained, most) << k << ' ' << is_field;
      EXPECT_LE(its.farthest, 1 + most) << k << ' ' << is_field;
      if (k > (is_field ? 0.01 : 10)) continue;          // else, the sub-steps resolve the swing
      EXPECT_GE(its.late, is_field ? 0.99 : 0.98) << k;  // some of its ends are between ticks
    }
  }
}

// The spring pulls along the circle or away from it. The joint solver follows swings of up to some radians
// per tick with order 6, and damps faster swings.
TEST_F(BodyScenes, RodAndSpringGainNoEnergy) {
  const double g = perSecondSquared(Vector(0, kFall)).y();
  PM.setGravity(Vector(0, g));
  for (const double to : {4.0, 5.0}) {
    for (double k = 0.01; k <= 1.01e12; k *= std::sqrt(10.0)) {
      Body* p_bob = ball(Vector(3, 4), Vector(), 0.25);
      PM.addDistance(nullptr, p_bob, Vector(), Vector(3, 4));
      p_bob->setSpring(Vector(0, to), k);
      const auto energy = [&] {
        const Vector at = p_bob->getPosition(), v = p_bob->getVelocity();
        const double away = std::hypot(at.x(), at.y() - to);
        return 0.5 * (v.x() * v.x() + v.y() * v.y()) + 0.5 * k * away * away - g * at.y();
      };
      const double start = energy();
      for (int i = 0; i < 300; ++i) {
        ticks(1);
        ASSERT_LE(energy() - start, 1e-6 * (start + 9 * g)) << to << ' ' << k << ' ' << i;
      }
      EXPECT_FALSE(p_bob->isFrozen()) << to << ' ' << k;
      delete p_bob;
    }
  }
}

// The rate is in rad per tick, from x to y.
FieldOf magnetOf(double rate) {
  return FieldOf([rate](Vector /*displacement*/, Vector v) { return Vector(-rate * v.y(), rate * v.x()); });
}

// A magnet presses sliding bodies onto the floor and rotating bodies against their rod. Its force is
// perpendicular to the path, so the speed must not change.
TEST_F(BodyScenes, MagnetKeepsTheSpeedOfHeldBodies) {
  wall(Vector(0, 0.5), Vector(500, 0.5));
  for (const Accuracy accuracy : {ACCURACY_DEFAULT, ACCURACY_FAST}) {
    ASSERT_EQ(PM.setAccuracy(accuracy), 0);
    // The fast level is soft, so the first push of a strong magnet reduces the speed a little.
    const double least = accuracy == ACCURACY_DEFAULT ? 0.1 * (1 - 1e-4) : 0.07;
    for (const double rate : {0.01, 1.0, 100.0, 1e4, -1.0, -1e4}) {
      SCOPED_TRACE(testing::Message() << accuracy << ' ' << rate);
      const FieldOf magnet = magnetOf(rate);
      put(ball(Vector(5, -20), Vector(0, 3), 0.25));
      PM.addDistance(nullptr, bodies[0], Vector(0, -20), Vector(5, -20));
      put(ball(Vector(100, -0.5), Vector(3, 0)))->setRestitution(0);
      put(turningCrate(Vector(-100, -0.5)));
      bodies[2]->setFriction(0);
      bodies[2]->setVelocity(Vector(0.1, 0));
      for (Body* p_body : bodies) p_body->setField(&magnet);
      for (int i = 0; i < 300; ++i) {
        ticks(1);
        for (const Body* p_body : bodies) {
          ASSERT_LE(p_body->getVelocity().getMagnitude(), 0.1 * (1 + 1e-6)) << i;
          const bool may_land = rate < 0 && p_body != bodies[0];  // such a body may leave the floor and fall
                                                                  // back
          if (!may_land) {
            ASSERT_GE(p_body->getVelocity().getMagnitude(), least) << i;
          }
        }
      }
      EXPECT_EQ(PM.getQuarantineCount(), 0U);
      deleteBodies();
    }
  }
}

// A magnet of any strength freezes no body: at both levels, in flight, on a floor, on a rod and in a
// collision.
TEST_F(BodyScenes, StrongMagnetFreezesNoBodies) {
  layFloor(50, 0.5);
  for (const Accuracy accuracy : {ACCURACY_DEFAULT, ACCURACY_FAST}) {
    ASSERT_EQ(PM.setAccuracy(accuracy), 0);
    for (const double rate : {1.0, 100.0, 1e3, 1e4, 1e8}) {
      const FieldOf magnet = magnetOf(rate);
      put(ball(Vector(-20, -20), Vector(3, 0)))->setGravityScale(0);
      put(ball(Vector(0, -0.5), Vector(3, 0)));
      put(turningCrate(Vector(10, -0.5)));
      put(turningCrate(Vector(10.9, -1.4)));
      put(ball(Vector(25, -10), Vector(0, 3)));
      PM.addDistance(nullptr, bodies.back(), Vector(20, -10), Vector(25, -10));
      for (Body* p_body : bodies) p_body->setField(&magnet);
      for (int i = 0; i < 100; ++i) {
        ticks(1);
        EXPECT_NEAR(bodies[0]->getVelocity().getMagnitude(), 0.1, 1e-6) << rate << ' ' << i;
        for (const Body* p_body : bodies) {
          ASSERT_LE(p_body->getVelocity().getMagnitude(), 2) << rate << ' ' << i;
          ASSERT_LT(p_body->getPosition().y(), 0) << rate << ' ' << i;
        }
      }
      EXPECT_EQ(PM.getQuarantineCount(), 0U) << rate;
      deleteBodies();
    }
  }
}

// A spring joint with a rest length pulls a body off the spring's line. No integrator can follow it, but no
// body is frozen.
TEST_F(BodyScenes, StiffSpringJointHoldsABodyOnAFloor) {
  layFloor(50, 0.5);
  for (const double k : kStiffnesses) {
    Body* p_box = turningCrate(Vector(1, -0.5));
    p_box->setFriction(0);
    PM.addSpring(nullptr, p_box, Vector(0, -0.5), Vector(1, -0.5), k);
    p_box->setVelocity(Vector(0.01, 0));
    ticks(300);
    EXPECT_FALSE(p_box->isFrozen()) << k;
    EXPECT_NEAR(p_box->getPosition().x(), 1, 0.11) << k;
    EXPECT_NEAR(p_box->getPosition().y(), -0.5, 1e-3) << k;
    delete p_box;
  }
}

// A spring joint in the air, at both levels, for a HARD and a SPECTRAL body.
TEST_F(BodyScenes, StiffSpringJointHoldsABodyInTheAir) {
  for (const Accuracy accuracy : {ACCURACY_DEFAULT, ACCURACY_FAST}) {
    ASSERT_EQ(PM.setAccuracy(accuracy), 0);
    for (const Solidness solidness : {HARD, SPECTRAL}) {
      Body* p_bob = ball(Vector(1, 0), Vector(), 0.25);
      p_bob->setSolidness(solidness);
      PM.addSpring(nullptr, p_bob, Vector(), Vector(1, 0), 1e8);
      p_bob->setVelocity(Vector(0, 0.2));
      for (int i = 0; i < 100; ++i) {
        ticks(1);
        const Vector at = p_bob->getPosition();
        ASSERT_NEAR(std::hypot(at.x(), at.y()), 1, 0.1) << accuracy << ' ' << solidness << ' ' << i;
      }
      EXPECT_FALSE(p_bob->isFrozen()) << accuracy << ' ' << solidness;
      delete p_bob;
    }
  }
}

// A moving belt drags a box that a spring pulls back.
TEST_F(BodyScenes, StickAndSlipStaysBounded) {
  PM.setGravity(perSecondSquared(Vector(0, kFall)));
  for (const double omega : {0.01, 0.1, 1.0, 10.0}) {
    Body* p_belt = crate(Vector(0, 0.5), Vector(5000, 0.5));
    p_belt->setKinematic();
    p_belt->setVelocity(Vector(0.05, 0));
    Body* p_box = turningCrate(Vector(0, -0.5));
    p_box->setSpring(Vector(0, -0.5), omega * omega);
    const double most = 0.05 * 301;  // it cannot move farther than the belt
    for (int i = 0; i < 300; ++i) {
      ticks(1);
      ASSERT_LE(std::abs(p_box->getPosition().x()), most) << omega << ' ' << i;
      ASSERT_LE(std::abs(p_box->getVelocity().x()), 1) << omega << ' ' << i;
    }
    EXPECT_FALSE(p_box->isFrozen()) << omega;
    delete p_box;
    delete p_belt;
  }
}

// The floor supports the whole width of the box, at any speed.
TEST_F(PulledBox, FastSlidingBoxDoesNotSinkIntoTheFloor) {
  for (double k = 0.01; k <= 2; k *= 1.1) {  // up to 1.4 times its width per tick
    const Swing its = swing(k, [&](Body* p_box) { p_box->setSpring(Vector(0, -0.5), k); });
    EXPECT_LE(its.gained, 1e-6) << k;
    EXPECT_LE(its.sunk, 1e-6) << k;
  }
}

// A body of up to 10⁹ times the mass rests on light ones as on an immovable one.
TEST_F(BodyScenes, AHeavyBodyLiesOnLightOnes) {
  layFloor(50, 0.5);
  for (const double ratio : {10.0, 1e3, 1e6, 1e7, 1e9}) {
    for (const int lights : {1, 2, 3}) {
      for (int i = 0; i <= lights; ++i) {
        put(turningCrate(Vector(0, -0.5 - i), Vector(0.5, 0.5), i < lights ? 1 : ratio));
        bodies.back()->setFriction(0.6);
      }
      ticks(300);
      for (int i = 0; i <= lights; ++i) {
        EXPECT_NEAR(bodies[static_cast<std::size_t>(i)]->getPosition().y(), -0.5 - i, 1e-3)
            << ratio << ' ' << lights << ' ' << i;
      }
      deleteBodies();
    }
  }
}

// A heavy body lies or falls on light ones, on their middle or off it. No body is thrown away. Up to a
// mass ratio of 10⁶, none is pressed into the floor by half its height; above, none gets half-way through the
// floor. The fast level guarantees no positions, because it squeezes bodies.
TEST_F(BodyScenes, HeavyBodyDoesNotThrowLightOnes) {
  const double g = perSecondSquared(Vector(0, kFall)).y();
  PM.setGravity(Vector(0, g));
  wall(Vector(0, 0.5), Vector(50, 0.5));
  for (const Accuracy accuracy : {ACCURACY_DEFAULT, ACCURACY_FAST}) {
    ASSERT_EQ(PM.setAccuracy(accuracy), 0);
    for (const double ratio : {2.0, 4.0, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e9, 1e12}) {
      const double deepest = accuracy == ACCURACY_FAST ? 1e9 : ratio <= 1e6 ? 0 : 0.5;
      for (int variant = 0; variant < 18; ++variant) {
        SCOPED_TRACE(testing::Message() << accuracy << ' ' << ratio << ' ' << variant);
        const int lights = 1 + variant % 3;
        const double drop = std::array{0.0, 0.01, 3.0}.at(static_cast<std::size_t>(variant / 3 % 3));
        for (int i = 0; i < lights; ++i) put(crate(Vector(0, -0.5 - i)));
        put(crate(Vector(variant < 9 ? 0 : 0.45, -0.5 - lights - drop), Vector(0.5, 0.5), ratio));
        for (Body* p_body : bodies) p_body->setTurning();
        const auto energy = [&] {
          double sum = kinetic();
          for (const Body* p_body : bodies) sum -= p_body->getMass() * g * p_body->getPosition().y();
          return sum;
        };
        const double start = energy(), most = start + 1e-6 * ratio * g * (lights + 0.5 + drop);
        for (int i = 0; i < 150; ++i) {
          ticks(1);
          ASSERT_LE(energy(), most) << i;
          for (const Body* p_body : bodies) ASSERT_LT(p_body->getPosition().y(), deepest) << i;
        }
        EXPECT_EQ(PM.getQuarantineCount(), 0U);
        deleteBodies();
      }
    }
  }
}

// The net has too many loops of hinges for a direct solution, even after one hinge is removed.
TEST_F(BodyScenes, ANetOfManyLoopsIsMovedInSubsteps) {
  constexpr int kSide = 12;
  PM.setGravity(perSecondSquared(Vector(0, kFall)));
  std::vector<std::pair<Joint, std::array<const Body*, 2>>> hinges;
  for (int i = 0; i < kSide * kSide; ++i) {
    Body* p_disc = put(ball(Vector(i % kSide, i / kSide), Vector(), 0.4));
    p_disc->setSolidness(SPECTRAL);
    p_disc->setTurning();
    if (i < kSide && i % 4 == 0) p_disc->setKinematic();
  }
  const auto join = [&](int a, int b, Vector where) {
    Body *p_a = bodies[static_cast<std::size_t>(a)], *p_b = bodies[static_cast<std::size_t>(b)];
    hinges.push_back({PM.addHinge(p_a, p_b, where), {p_a, p_b}});
  };
  for (int i = 0; i < kSide * kSide; ++i) {
    const Vector at(i % kSide, i / kSide);
    if (i % kSide + 1 < kSide) join(i, i + 1, at + Vector(0.5, 0));
    if (i / kSide + 1 < kSide) join(i, i + kSide, at + Vector(0, 0.5));
  }
  const auto widest = [&] {
    double most = 0;
    for (const auto& [hinge, ends] : hinges) {
      if (!hinge.exists()) continue;
      const Vector apart = ends[1]->getPosition() - ends[0]->getPosition();
      most = std::max(most, std::hypot(apart.x(), apart.y()));
    }
    return most;
  };
  ticks(20);
  EXPECT_EQ(layer().substepCounters().ticks, 20);
  EXPECT_LE(widest(), 1.4);
  hinges[40].first.remove();
  ticks(100);
  EXPECT_EQ(layer().substepCounters().ticks, 120);
  EXPECT_LE(widest(), 1.4);
  EXPECT_EQ(PM.getQuarantineCount(), 0U);
}

// The crowd moves in sub-steps. Its momentum is constant, its centre of mass moves accordingly, and no body
// stops where a free one would move on. A body that passes the crowd is not affected.
TEST_F(BodyScenes, MovingCrowdKeepsMomentumAndNeverStalls) {
  constexpr int kCount = 900;
  naiad::SplitMix64 random(3);
  for (int i = 0; i < kCount; ++i) {
    const double x = random.unit(), y = random.unit(), mass = 0.5 + random.unit();
    const Vector velocity(3 * random.unit(), 2 * random.unit() - 1);
    put(ball(Vector(x, y), velocity))->setRestitution(0);
    bodies.back()->setMass(mass);
  }
  const Body* p_flyer = ball(Vector(-30, 40), Vector(30, 15));
  const auto centre = [&] {
    Vector sum;
    double mass = 0;
    for (const Body* p_body : bodies) {
      const Vector place = p_body->getPosition();
      sum = sum + Vector(p_body->getMass() * place.x(), p_body->getMass() * place.y());
      mass += p_body->getMass();
    }
    return Vector(sum.x() / mass, sum.y() / mass);
  };
  double mass = 0;
  for (const Body* p_body : bodies) mass += p_body->getMass();
  const Vector start = momentum(), from = centre();
  for (int i = 1; i <= 60; ++i) {
    std::vector<Vector> before;
    for (const Body* p_body : bodies) before.push_back(p_body->getPosition());
    ticks(1);
    const Vector now = momentum(), at = centre();
    ASSERT_NEAR(now.x(), start.x(), 1e-12 * mass) << i;
    ASSERT_NEAR(now.y(), start.y(), 1e-12 * mass) << i;
    ASSERT_NEAR(at.x(), from.x() + i * start.x() / mass, 1e-5) << i;
    ASSERT_NEAR(at.y(), from.y() + i * start.y() / mass, 1e-5) << i;
    for (std::size_t k = 0; k < bodies.size(); ++k) {
      ASSERT_NE(bodies[k]->getPosition(), before[k]) << "tick " << i << ", body " << k;
    }
  }
  EXPECT_GE(layer().substepCounters().ticks, 10);
  EXPECT_NEAR(p_flyer->getPosition().x(), 30, 1e-9);
  EXPECT_NEAR(p_flyer->getPosition().y(), 70, 1e-9);
  EXPECT_EQ(PM.getQuarantineCount(), 0U);
}

TEST_F(BodyScenes, TurningSwarmsKeepTheirMomentumAtBothLevels) {
  constexpr int kSide = 10;
  for (int seed = 0; seed < 10; ++seed) {
    PM.setAccuracy(seed % 2 == 0 ? ACCURACY_DEFAULT : ACCURACY_FAST);
    naiad::SplitMix64 random(static_cast<std::uint64_t>(seed));
    for (int i = 0; i < kSide * kSide; ++i) {
      const double x = 1.5 * (i % kSide) - 6.75, y = 1.5 * (i / kSide) - 6.75;
      Body* p_disc =
          put(ball(Vector(x, y), Vector(random.unit() - 0.3 - 0.3 * x, random.unit() - 0.5 - 0.3 * y)));
      p_disc->setTurning();
      p_disc->setSpin(0.07 * (random.unit() - 0.5));
      p_disc->setFriction(0.5);
      p_disc->setRestitution(0.5);
    }
    const Vector start = momentum();
    for (int i = 0; i < 150; ++i) {
      ticks(1);
      const Vector now = momentum();
      ASSERT_LE(std::hypot(now.x() - start.x(), now.y() - start.y()), 1e-12) << seed << ' ' << i;
    }
    deleteBodies();
  }
}

}  // namespace
}  // namespace df::test
