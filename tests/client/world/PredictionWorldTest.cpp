// The client's prediction in a real world: the world then does what the client showed.
#include <gtest/gtest.h>

#include "FarPlayer.h"
#include "engine/world/Controls.h"
#include "engine/world/EventCollision.h"

namespace naiad::test {
namespace {

using df::Box;
using df::Controls;
using df::Object;
using df::Vector;
using df::Keyboard::Key;

constexpr Key kKeys[] = {df::Keyboard::A, df::Keyboard::B, df::Keyboard::C,
                         df::Keyboard::D, df::Keyboard::E, df::Keyboard::F};

double between(SplitMix64& rng, double low, double high) {
  return low + (high - low) * rng.unit();
}

df::Solidness anySolidness(SplitMix64& rng) {
  return static_cast<df::Solidness>(rng.below(3));
}

/// Adds fixed walls and fog with whole and fractional boxes.
void litter(SplitMix64& rng, int count) {
  for (int i = 0; i < count; ++i) {
    auto* p_o = new Object;
    p_o->setSolidness(anySolidness(rng));
    p_o->setPosition(Vector(between(rng, 0, 200), between(rng, 0, 60)));
    if (rng.below(3) == 0) {
      p_o->setBox(
          Box(Vector(between(rng, -4, 0), between(rng, -2, 0)), between(rng, 0, 8), between(rng, 0, 4)));
    }
  }
}

Controls anyControls(SplitMix64& rng) {
  Controls controls;
  const int style = static_cast<int>(rng.below(4));  // steps, velocities, drives, or all of them
  for (const Key key : kKeys) {
    const double dx = static_cast<double>(rng.below(9)) / 4 - 1;
    const double dy = static_cast<double>(rng.below(9)) / 4 - 1;
    const int kind = style < 3 ? style : static_cast<int>(rng.below(3));
    controls.onKey(key, static_cast<df::EventKeyboardAction>(rng.below(3)));
    if (kind == 0)
      controls.step(dx, dy).every(static_cast<int>(rng.below(5)), static_cast<int>(rng.below(2)));
    if (kind == 1) rng.below(2) == 0 ? controls.velocityX(dx) : controls.velocity(dx, dy);
    if (kind == 2) controls.drive(dx, rng.below(2) == 0 ? 0 : dy / 3);
  }
  if (rng.below(2) == 0) controls.toWholeCells();
  if (rng.below(2) == 0) controls.releaseAfter(5 + static_cast<int>(rng.below(30)));
  if (rng.below(2) == 0) controls.within(Box(Vector(20, 10), 160, 40));
  return controls;
}

Object* launch(FarPlayer& far, const Controls& controls) {
  auto* p_ship = new Object;
  p_ship->setPosition(Vector(100, 30));
  far.player().setObject(p_ship);
  EXPECT_EQ(far.player().setControls(controls), 0);
  return p_ship;
}

void playAtRandom(FarPlayer& far, int steps) {
  for (int i = 0; i < steps; ++i) {
    far.step();
    if (far.rng.below(3) == 0)
      far.press(kKeys[far.rng.below(6)], static_cast<df::EventKeyboardAction>(far.rng.below(3)));
  }
}

LinkDelays anyDelays(SplitMix64& rng) {
  const auto ticks = [&] { return static_cast<std::uint32_t>(rng.below(10)); };
  return {ticks(), ticks(), 0, 1};
}

/// A world in which only the player moves.
void playAmongWalls(FarPlayer& far, int steps) {
  WM.setBoundary(Box(Vector(), 200, 60));
  far.world.views().setWindow(120, 54);  // the client does not know objects outside the view
  litter(far.rng, 150);
  Object* p_ship = launch(far, anyControls(far.rng));
  if (far.rng.below(3) == 0) litter(far.rng, 50);  // created after the ship
  p_ship->setSolidness(anySolidness(far.rng));
  p_ship->setNoSoft(far.rng.below(4) == 0);
  if (far.rng.below(6) == 0) p_ship->setAcceleration(Vector(0, 0.01));
  far.stepUntilAllKnown();
  far.compared = far.wrong = far.wrong_views = 0;
  playAtRandom(far, steps);
}

TEST(PredictionWorld, EveryFrameIsRightIfNothingElseMoves) {
  int inputs = 0;
  int compared = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    SplitMix64 rng(seed);
    FarPlayer far(anyDelays(rng), seed);
    playAmongWalls(far, 300);
    EXPECT_EQ(far.late_inputs, 0);
    EXPECT_EQ(far.wrong, 0) << "seed " << seed;
    EXPECT_EQ(far.wrong_views, 0) << "seed " << seed;
    EXPECT_EQ(far.prediction.counters().mispredicted, 0u) << "seed " << seed;
    EXPECT_GT(far.prediction.counters().confirmed, 50u);
    inputs += far.inputs;
    compared += far.compared;
  }
  EXPECT_GT(inputs, 5000);
  EXPECT_GT(compared, 15000);
}

TEST(PredictionWorld, LossWithinTheMarginCausesNoMispredictions) {
  int inputs = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    FarPlayer far({4, 3, 0.2, 10}, seed);
    playAmongWalls(far, 300);
    ASSERT_EQ(far.late_inputs, 0);
    EXPECT_EQ(far.wrong, 0) << "seed " << seed;
    EXPECT_EQ(far.prediction.counters().mispredicted, 0u) << "seed " << seed;
    inputs += far.inputs;
  }
  EXPECT_GT(inputs, 1500);
}

TEST(PredictionWorld, PredictedControlStatesAreNotSent) {
  int states = 0;
  int ticks = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    FarPlayer far({4, 3, 0, 1}, seed);
    playAmongWalls(far, 300);
    EXPECT_EQ(far.wrong, 0) << "seed " << seed;
    states += far.states;
    ticks += far.ticks;
  }
  EXPECT_LT(states, ticks * 3 / 4);  // with a key every third tick, and walls
}

/// Moves back and forth by whole cells, so that its model has no rounding errors.
class Shuttle : public Object {
 public:
  Shuttle(Vector at, int direction) {
    setPosition(at);
    setVelocity(Vector(direction, 0));
  }
  int eventHandler(const df::Event* p_e) override {
    if (p_e->getType() != df::COLLISION_EVENT) return 0;
    const auto* p_c = static_cast<const df::EventCollision*>(p_e);
    if (p_c->getObject1() == this) setVelocity(Vector(-getVelocity().x(), 0));
    return 1;
  }
};

TEST(PredictionWorld, MispredictedCollisionsAreCorrectedWithinARoundTrip) {
  int wrong = 0;
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    FarPlayer far({4, 4, 0, 1}, seed);
    Controls controls;
    int i = 0;
    for (const Vector d : {Vector(1, 0), Vector(-1, 0), Vector(0, 1), Vector(0, -1)})
      controls.onKey(kKeys[i++]).step(d.x(), d.y());
    controls.onKey(df::Keyboard::E).velocity(1, 0).onKey(df::Keyboard::F).velocity(-1, 0);
    WM.setBoundary(Box(Vector(), 200, 60));
    launch(far, controls.within(Box(Vector(80, 20), 40, 20)));
    std::vector<Shuttle*> shuttles;
    for (int n = 0; n < 30; ++n) {
      shuttles.push_back(new Shuttle(
          Vector(80 + static_cast<double>(far.rng.below(40)), 20 + static_cast<double>(far.rng.below(20))),
          n % 2 == 0 ? 1 : -1));
    }
    playAtRandom(far, 200);
    wrong += far.wrong;
    EXPECT_GT(far.compared, 150);

    for (Shuttle* p_shuttle : shuttles) p_shuttle->setVelocity(Vector());
    for (std::uint32_t n = 0; n < 10; ++n) far.step();  // until the last correction has arrived
    far.compared_from = far.tick() + 1;
    for (std::uint32_t n = 0; n < far.lead() + 1; ++n) far.step();  // until older frames have been compared
    far.wrong = 0;
    playAtRandom(far, 100);
    EXPECT_EQ(far.wrong, 0) << "seed " << seed;
  }
  EXPECT_GT(wrong, 100);  // otherwise nothing was corrected
}

TEST(PredictionWorld, LateInputsAreCorrectedAndTheShipNeverDiverges) {
  int late = 0;
  std::uint64_t mispredicted = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    FarPlayer far({4, 3, 0.3, 0}, seed);
    playAmongWalls(far, 200);
    late += far.late_inputs;
    mispredicted += far.prediction.counters().mispredicted;
    for (int n = 0; n < 80; ++n) far.step();  // without keys, until all states have arrived
    const df::FixedVector at = far.prediction.position();
    far.prediction.run(far.replica, far.tick() + far.lead());
    EXPECT_EQ(far.prediction.pendingInputs(), 0u);
    EXPECT_EQ(far.prediction.position(), at);
    far.wrong = 0;
    for (int n = 0; n < 20; ++n) far.step();
    EXPECT_EQ(far.wrong, 0) << "seed " << seed;
  }
  EXPECT_GT(late, 50);
  EXPECT_GT(mispredicted, 20u);
}

TEST(PredictionWorld, KeyShowsInTheNextFrameAtAnyDelay) {
  for (const std::uint32_t delay : {0u, 1u, 3u, 10u, 25u}) {
    FarPlayer far({delay, delay, 0, 2}, 1);
    launch(far, Controls().onKey(df::Keyboard::D).step(1, 0).onKey(df::Keyboard::S).drive(0, 1));
    for (std::uint32_t n = 0; n < delay + 3; ++n) far.step();
    ASSERT_TRUE(far.prediction.isActive());
    const df::FixedVector start = far.prediction.position();
    far.press(df::Keyboard::D);
    far.step();
    EXPECT_EQ(far.prediction.position(), (start + df::FixedVector{df::kFixedOne, 0})) << delay;
    far.press(df::Keyboard::S);
    far.step();
    EXPECT_EQ(far.prediction.position(), (start + df::FixedVector{df::kFixedOne, df::kFixedOne})) << delay;
    for (std::uint32_t n = 0; n < 2 * delay + 10; ++n) far.step();
    EXPECT_EQ(far.wrong, 0);
    EXPECT_EQ(far.prediction.pendingInputs(), 0u);
  }
}

}  // namespace
}  // namespace naiad::test
