// Newton's cradle and similar scenes through WM.update(): jointed circles hit one another in sequence.
#include <array>

#include "tests/server/physics/BodyScene.h"

namespace df::test {
namespace {

constexpr int kBalls = 5;
constexpr double kRod = 5;
constexpr double kGravity = 10;
constexpr double kAngle = 0.5235987755982988;  // 30°

class BodyCradle : public BodyScene {
 protected:
  BodyCradle() { PM.setGravity(perSecondSquared(Vector(0, kGravity))); }

  /// Hangs balls of diameter 1 on rods, side by side, and releases the first `raised` ones at 30°. y grows
  /// downward.
  void hang(int raised, double apart = 1, double restitution = 1, Vector origin = Vector()) {
    for (int i = 0; i < kBalls; ++i) {
      const Vector pivot = origin + Vector(i * apart, 0);
      const double angle = i < raised ? -kAngle : 0;
      const Vector offset(kRod * std::sin(angle), kRod * std::cos(angle));
      balls.at(static_cast<std::size_t>(i)) = ball<Listener>(pivot + offset, Vector());
      balls.at(static_cast<std::size_t>(i))->setRestitution(restitution);
      PM.addDistance(nullptr, balls.at(static_cast<std::size_t>(i)), pivot, pivot + offset);
      hung.at(static_cast<std::size_t>(i)) = pivot + Vector(0, kRod);
    }
  }
  /// Returns the speed that a ball's energy gives at its lowest place, over that of a ball released at 30°.
  double speedOfEnergy(int i) const {
    const Listener* p_ball = balls.at(static_cast<std::size_t>(i));
    const Vector v = speedOf(p_ball),
                 offset = p_ball->getDisplacementFrom(hung.at(static_cast<std::size_t>(i)));
    const double energy = 0.5 * (v.x() * v.x() + v.y() * v.y()) - kGravity * offset.y();
    return std::sqrt(std::max(0.0, energy / (kGravity * kRod * (1 - std::cos(kAngle)))));
  }

  std::array<Listener*, kBalls> balls = {};
  std::array<Vector, kBalls> hung = {};
};

TEST_F(BodyCradle, SwingsForAMinuteWithoutLoss) {
  hang(1);
  int changes = 0;
  bool was_first = true;
  for (int tick = 0; tick < 1800; ++tick) {
    ticks(1);
    const bool is_first = speedOfEnergy(0) > 0.5;
    ASSERT_NEAR(speedOfEnergy(0) + speedOfEnergy(kBalls - 1), 1, 1e-3) << tick;
    for (int i = 1; i < kBalls - 1; ++i) ASSERT_LE(speedOfEnergy(i), 1e-3) << tick << " " << i;
    if (is_first != was_first) ++changes;
    was_first = is_first;
  }
  EXPECT_EQ(changes, 27);  // half a swing takes 2.260 s, and the first impact is after half of that
}

TEST_F(BodyCradle, TwoBallsStrikeAndTwoLeave) {
  hang(2);
  ticks(45);
  for (int i = 0; i < kBalls; ++i) EXPECT_NEAR(speedOfEnergy(i), i >= kBalls - 2 ? 1 : 0, 1e-3) << i;
}

TEST_F(BodyCradle, TouchingBallsHangStill) {
  hang(0);
  ticks(300);
  for (int i = 0; i < kBalls; ++i) {
    const Listener* p_ball = balls.at(static_cast<std::size_t>(i));
    EXPECT_EQ(p_ball->getDisplacementFrom(hung.at(static_cast<std::size_t>(i))), Vector()) << i;
    EXPECT_EQ(p_ball->getVelocity(), Vector()) << i;
    EXPECT_TRUE(p_ball->notes.empty()) << i;
  }
}

TEST_F(BodyCradle, EveryImpactSendsBothBallsOneEvent) {
  hang(1);
  ticks(45);
  for (std::size_t i = 0; i < kBalls; ++i) {
    const std::size_t impacts = i == 0 || i == kBalls - 1 ? 1 : 2;
    ASSERT_EQ(balls.at(i)->notes.size(), impacts) << i;
    const double speed = std::sqrt(2 * kGravity * kRod * (1 - std::cos(kAngle))) / 30;
    for (const Listener::Note& note : balls.at(i)->notes) {
      EXPECT_TRUE(note.is_begin);
      EXPECT_NEAR(note.impulse, speed, 1e-6);
    }
  }
}

// The balls that are hit are so fast that they leave the area that was searched around them.
TEST_F(BodyCradle, FreeBallPassesItsSpeedThroughTheCradle) {
  PM.setGravity(Vector());
  hang(0);
  Listener* p_shot = ball<Listener>(hung[0] + Vector(-5, 0), Vector(30, 0));
  ticks(5);
  EXPECT_NEAR(speedOf(p_shot).x(), 0, 1e-9);
  for (std::size_t i = 0; i + 1 < kBalls; ++i) EXPECT_NEAR(speedOf(balls.at(i)).x(), 0, 1e-9) << i;
  const Vector v = speedOf(balls[4]);
  EXPECT_NEAR(std::hypot(v.x(), v.y()), 30, 1e-4);
}

TEST_F(BodyCradle, BehavesTheSameFarAway) {
  hang(0);
  balls[0]->setVelocity(perSecond(Vector(-2, 0)));
  ticks(120);
  std::array<Vector, kBalls> near;
  for (std::size_t i = 0; i < kBalls; ++i) near.at(i) = balls.at(i)->getDisplacementFrom(hung.at(i));
  for (Listener* p_ball : balls) delete p_ball;
  hang(0, 1, 1, Vector(1e6, -1e6));
  balls[0]->setVelocity(perSecond(Vector(-2, 0)));
  ticks(120);
  for (std::size_t i = 0; i < kBalls; ++i)
    EXPECT_EQ(balls.at(i)->getDisplacementFrom(hung.at(i)), near.at(i)) << i;
}

// Two boxes that collide far away change no bit.
TEST_F(BodyCradle, MovesTheSameBesideFlyingBoxes) {
  std::array<std::array<Vector, kBalls>, 2> places;
  for (std::size_t run = 0; run < 2; ++run) {
    Body* boxes[] = {run == 0 ? nullptr : ball<Listener>(Vector(2000, 0), Vector(40, -3)),
                     run == 0 ? nullptr : ball<Listener>(Vector(2030, 0), Vector(-40, -2))};
    for (Body* p_box : boxes) {
      if (p_box == nullptr) continue;
      p_box->setBoxShape(1, 2);
      p_box->setTurning();
    }
    hang(1);
    ticks(150);
    for (std::size_t i = 0; i < kBalls; ++i) {
      places.at(run).at(i) = balls.at(i)->getDisplacementFrom(hung.at(i));
      delete balls.at(i);
    }
    for (Body* p_box : boxes) delete p_box;
  }
  EXPECT_EQ(places[0], places[1]);
}

// With restitution 0.5, each impact transfers 3/4 of the speed.
TEST_F(BodyCradle, EnergyLossMatchesEachImpact) {
  hang(1, 1, 0.5);
  ticks(36);  // the first impact is in the 35th tick
  const double left = std::pow(0.75, kBalls - 1);
  EXPECT_NEAR(speedOfEnergy(kBalls - 1), left, 1e-3);
}

// The balls are nearer than their rods allow, so they press on each other and no sequence of bounces is a
// solution.
TEST_F(BodyCradle, PressingBallsAreKeptApart) {
  for (const double restitution : {0.5, 1.0}) {
    hang(0, 0.99, restitution);
    ticks(300);
    for (std::size_t i = 0; i + 1 < kBalls; ++i) {
      const Vector offset =
          balls.at(i + 1)->getDisplacementFrom(hung.at(i)) - balls.at(i)->getDisplacementFrom(hung.at(i));
      EXPECT_GT(std::hypot(offset.x(), offset.y()), 0.98) << restitution << " " << i;
      EXPECT_LT(std::abs(speedOf(balls.at(i)).x()), 3) << restitution << " " << i;
    }
    for (Listener* p_ball : balls) delete p_ball;
  }
}

}  // namespace
}  // namespace df::test
