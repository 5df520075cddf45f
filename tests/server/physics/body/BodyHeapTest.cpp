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

// Planks that lie on one another have no acceleration relative to each other, but do not bounce.
TEST_F(BodyHeap, FewPlanksInATrayComeToRest) {
  naiad::physics::test::SceneRandom random;
  for (const double length : {2.0, 6.0, 12.0}) {
    for (const double height : {0.1, 0.4}) {
      OwnWorld own(1, Vector(0, 0.0111));
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

// Makes a card house on the floor, of pairs of leaning cards whose tops carry flat ones.
std::vector<Body*> cardHouse(int storeys) {
  constexpr double kLean = 0.35, kThickness = 0.05;
  std::vector<Body*> cards;
  const auto put = [&](Vector place, Vector half, double angle) {
    cards.push_back(BodyScene::turningCrate(place, half));
    cards.back()->setAngle(angle);
    cards.back()->setFriction(0.8);
  };
  const double rise = 0.5 * std::cos(kLean) + 0.5 * kThickness * std::sin(kLean);
  const double reach = 0.5 * std::sin(kLean) + 0.5 * kThickness * std::cos(kLean);
  double base = 0;
  for (int pairs = storeys; pairs > 0; --pairs) {
    for (int i = 0; i < pairs; ++i) {
      const double x = i - 0.5 * (pairs - 1);
      for (const double side : {-1.0, 1.0})
        put(Vector(x + side * reach, base - rise), Vector(0.5 * kThickness, 0.5), -side * kLean);
      if (i > 0) put(Vector(x - 0.5, base - 2 * rise - 0.5 * kThickness), Vector(0.5, 0.5 * kThickness), 0);
    }
    base -= 2 * rise + kThickness;
  }
  return cards;
}

TEST_F(BodyHeap, CardHousesStandAtBothLevels) {
  for (const Accuracy accuracy : {ACCURACY_DEFAULT, ACCURACY_FAST}) {
    for (int storeys = 2; storeys <= 6; ++storeys) {
      OwnWorld own(1, Vector(), accuracy);
      PM.setObstacleFriction(0.8);
      layFloor(100, 0.5);
      const std::vector<Body*> cards = cardHouse(storeys);
      std::vector<Vector> places;
      for (const Body* p_card : cards) places.push_back(p_card->getPosition());
      for (int tick = 0; tick < 300; ++tick) own.world.update();
      for (std::size_t i = 0; i < cards.size(); ++i) {
        const Vector now = cards[i]->getPosition();
        EXPECT_LT(std::hypot(now.x() - places[i].x(), now.y() - places[i].y()), 0.1) << storeys << " storeys";
        EXPECT_EQ(cards[i]->getVelocity(), Vector()) << storeys << " storeys, level " << accuracy;
      }
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
