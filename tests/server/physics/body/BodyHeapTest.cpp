// Large groups at ACCURACY_DEFAULT: what moves, or costs too much to be solved at once, goes on in soft
// sub-steps, and the change sends no event.
#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include "physics/body/BodyLayer.h"
#include "tests/server/physics/BodyScene.h"

namespace df::test {
namespace {

class BodyHeap : public BodyScene {
 protected:
  static constexpr double kFall = 10;  // per second²

  BodyHeap() {
    PM.setGravity(perSecondSquared(Vector(0, kFall)));
    wall(Vector(0, 0.5), Vector(100, 0.5));
  }
  const naiad::physics::RigidCounters& rigid() {
    return world.findLayer<naiad::physics::BodyLayer>()->rigidCounters();
  }
  const naiad::physics::SubstepCounters& heaps() {
    return world.findLayer<naiad::physics::BodyLayer>()->heapCounters();
  }
  Listener* put(Vector where) {
    auto* p_crate = crate<Listener>(where);
    p_crate->setTurning();
    p_crate->setFriction(0.6);
    p_crate->setContactEnds();
    bodies.push_back(p_crate);
    return p_crate;
  }
  double energy() const {
    double sum = 0;
    for (const Body* p_body : bodies) {
      const Vector v = p_body->getVelocity();
      sum += 0.5 * p_body->getMass() * (v.x() * v.x() + v.y() * v.y());
      sum += 0.5 * p_body->getInertia() * p_body->getSpin() * p_body->getSpin();
      sum -= p_body->getMass() * perSecondSquared(Vector(0, kFall)).y() * p_body->getPosition().y();
    }
    return sum;
  }
  // Each pair hears of begin and end by turns.
  void expectTurns() const {
    for (const Listener* p_body : bodies) {
      std::map<std::pair<const Object*, const Object*>, bool> touches;
      for (const Listener::Note& note : p_body->notes) {
        bool& is_touching = touches[{note.p_first, note.p_second}];
        EXPECT_NE(is_touching, note.is_begin);
        is_touching = note.is_begin;
      }
    }
  }

  std::vector<Listener*> bodies;
};

TEST_F(BodyHeap, ThatFallsTogetherIsMovedInSubstepsAndComesToRest) {
  for (int i = 0; i < 64; ++i) put(Vector(1.05 * (i % 8) + 0.1 * (i / 8 % 2), -1 - 1.3 * (i / 8)));
  double most = energy();
  const double start = most;
  for (int i = 0; i < 300; ++i) {
    ticks(1);
    EXPECT_LE(energy(), most + 1e-2 * std::abs(start)) << i;
    most = std::min(most, energy());
  }
  EXPECT_GT(heaps().ticks, 100);
  EXPECT_LT(rigid().ticks, 60);  // while it is in the air and where it lands
  expectTurns();
  for (const Body* p_body : bodies) {
    EXPECT_EQ(p_body->getVelocity(), Vector());
    EXPECT_LT(p_body->getPosition().y(), -0.45);
  }
  EXPECT_EQ(PM.getQuarantineCount(), 0U);
}

TEST_F(BodyHeap, APyramidOfNeighboursThatTouchComesToRest) {
  constexpr int kRows = 20;
  for (int row = 0; row < kRows; ++row) {
    for (int i = 0; i < kRows - row; ++i) put(Vector(i + 0.5 * row, -0.5 - row));
  }
  ticks(150);
  EXPECT_GT(heaps().ticks, 100);
  for (const Listener* p_body : bodies) {
    EXPECT_EQ(p_body->getVelocity(), Vector());
    for (const Listener::Note& note : p_body->notes) EXPECT_TRUE(note.is_begin);
  }
  expectTurns();
  EXPECT_NEAR(bodies.back()->getPosition().y(), 0.5 - kRows, 0.2);
}

// A few, even fast ones, are solved for at once.
TEST_F(BodyHeap, AFewThatFallStayExact) {
  for (int i = 0; i < 8; ++i) put(Vector(0.1 * (i % 2), -1 - 1.5 * i));
  ticks(200);
  EXPECT_EQ(heaps().ticks, 0);
  expectTurns();
}

}  // namespace
}  // namespace df::test
