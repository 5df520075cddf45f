// Large groups at ACCURACY_DEFAULT. If a group moves, or costs too much for a direct solution, it continues
// in soft sub-steps, and this change of solver sends no event.
#include <algorithm>

#include "tests/server/physics/BodyScene.h"
#include "tests/server/physics/SceneRandom.h"

namespace df::test {
namespace {

class BodyHeap : public BodyScene {
 protected:
  BodyHeap() { layFloor(100, 0.5); }
  Listener* put(Vector where) {
    auto* p_crate = turningCrate<Listener>(where);
    p_crate->setFriction(0.6);
    p_crate->setContactEnds();
    bodies.push_back(p_crate);
    return p_crate;
  }
  double energy() const {
    double sum = 0;
    for (const Body* p_body : bodies) {
      sum += kineticOf(p_body);
      sum -= p_body->getMass() * PM.getGravity().y() * p_body->getPosition().y();
    }
    return sum;
  }
  void expectTurns() const {
    for (const Listener* p_body : bodies) p_body->expectTurns();
  }

  std::vector<Listener*> bodies;
};

TEST_F(BodyHeap, FallingHeapMovesInSubstepsAndComesToRest) {
  for (int i = 0; i < 64; ++i) put(Vector(1.05 * (i % 8) + 0.1 * (i / 8 % 2), -1 - 1.3 * (i / 8)));
  double most = energy();
  const double start = most;
  for (int i = 0; i < 300; ++i) {
    ticks(1);
    EXPECT_LE(energy(), most + 1e-2 * std::abs(start)) << i;
    most = std::min(most, energy());
  }
  EXPECT_GT(layer().heapCounters().ticks, 100);
  EXPECT_LT(layer().rigidCounters().ticks, 60);  // while it is in the air, and when it lands
  expectTurns();
  for (const Body* p_body : bodies) {
    EXPECT_EQ(p_body->getVelocity(), Vector());
    EXPECT_LT(p_body->getPosition().y(), -0.45);
  }
  EXPECT_EQ(PM.getQuarantineCount(), 0U);
}

TEST_F(BodyHeap, PyramidOfTouchingBoxesComesToRest) {
  constexpr int kRows = 20;
  for (int row = 0; row < kRows; ++row) {
    for (int i = 0; i < kRows - row; ++i) put(Vector(i + 0.5 * row, -0.5 - row));
  }
  ticks(150);
  EXPECT_GT(layer().heapCounters().ticks, 100);
  for (const Listener* p_body : bodies) {
    EXPECT_EQ(p_body->getVelocity(), Vector());
    for (const Listener::Note& note : p_body->notes) EXPECT_TRUE(note.is_begin);
  }
  expectTurns();
  EXPECT_NEAR(bodies.back()->getPosition().y(), 0.5 - kRows, 0.2);
}

// Planks that lie on one another have no acceleration relative to each other. Still they do not bounce for
// ever.
TEST_F(BodyHeap, FewPlanksInATrayComeToRest) {
  naiad::physics::test::SceneRandom random;
  for (const double length : {2.0, 6.0, 12.0}) {
    for (const double height : {0.1, 0.4}) {
      OwnWorld own;
      PM.setGravity(Vector(0, 0.0111));
      wall(Vector(0, 0.5), Vector(3.5 * length + 1, 0.5));
      for (const double side : {-1.0, 1.0})
        wall(Vector(side * (3.5 * length + 0.5), -10 * length), Vector(0.5, 10 * length));
      std::vector<Body*> planks;
      for (int i = 0; i < 10; ++i) {
        const Vector place((i % 5 - 2) * 1.15 * length + random() - 0.5, -length - 1.2 * length * (i / 5));
        Body* p_plank = turningCrate(place, Vector(0.5 * length, 0.5 * height));
        p_plank->setRestitution(0.2);
        p_plank->setAngle(random.between(0, 6));
        planks.push_back(p_plank);
      }
      const auto& its_layer = *own.world.findLayer<naiad::physics::BodyLayer>();
      for (int tick = 0; tick < 300; ++tick) own.world.update();
      for (const Body* p_plank : planks)
        EXPECT_EQ(p_plank->getVelocity(), Vector()) << length << ' ' << height;
      EXPECT_LT(its_layer.rigidCounters().sweeps, 100'000) << length << ' ' << height;
    }
  }
}

// A few bodies, even fast ones, are solved exactly.
TEST_F(BodyHeap, FewFallingBodiesAreSolvedExactly) {
  for (int i = 0; i < 8; ++i) put(Vector(0.1 * (i % 2), -1 - 1.5 * i));
  ticks(200);
  EXPECT_EQ(layer().heapCounters().ticks, 0);
  expectTurns();
}

}  // namespace
}  // namespace df::test
