#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "Body.h"
#include "GameMains.h"
#include "HostedGame.h"
#include "PhysicsManager.h"

namespace naiad {
namespace {

std::vector<df::Body*> bodies(df::World& world) {
  std::vector<df::Body*> found;
  const df::ObjectList all = world.objects().getAllObjects();
  df::ObjectListIterator li(&all);
  for (li.first(); !li.isDone(); li.next()) {
    if (auto* p_body = dynamic_cast<df::Body*>(li.currentObject())) found.push_back(p_body);
  }
  return found;
}

df::Body* bodyAt(df::World& world, df::Vector where) {
  for (df::Body* p_body : bodies(world)) {
    if ((p_body->getPosition() - where).getMagnitude() < 1.5) return p_body;
  }
  return nullptr;
}

void drag(df::World& world, std::uint32_t player, df::EventMouseAction action, int x, int y) {
  world.input().mouse(player, action, df::Mouse::LEFT, x, y);
  world.tick();
}

TEST(Sandbox, StructuresKeepStandingAndNothingIsLost) {
  hostGame(sandbox_main, 1, [](df::World& world) {
    world.input().join("ann", df::RED);
    tick(world, 30);
    const std::size_t count = bodies(world).size();
    df::Body* p_top = bodyAt(world, {48.3, 15.5});
    ASSERT_NE(p_top, nullptr);
    const df::Vector before = p_top->getPosition();
    tick(world, 300);
    EXPECT_LT((p_top->getPosition() - before).getMagnitude(), 0.05) << "the top of the pyramid";
    EXPECT_EQ(bodies(world).size(), count);
    for (const df::Body* p_body : bodies(world)) {
      EXPECT_TRUE(p_body->getPosition().x() > 0 && p_body->getPosition().x() < 79)
          << p_body->getPosition().x();
      EXPECT_TRUE(p_body->getPosition().y() > 1 && p_body->getPosition().y() < 23)
          << p_body->getPosition().y();
      EXPECT_FALSE(p_body->isFrozen());
    }
  });
}

TEST(Sandbox, DraggedBallFallsWhenReleased) {
  hostGame(sandbox_main, 1, [](df::World& world) {
    const std::uint32_t ann = joinAnn(world, 60);
    df::Body* p_ball = bodyAt(world, {4, 16});
    ASSERT_NE(p_ball, nullptr);
    const df::Vector at = p_ball->getPosition();
    drag(world, ann, df::CLICKED, static_cast<int>(at.x()), static_cast<int>(std::floor(at.y() + 0.5)));
    for (int t = 0; t < 60; ++t) drag(world, ann, df::PRESSED, 4, 8);
    EXPECT_LT(std::abs(p_ball->getPosition().y() - 8), 2) << "held up";
    tick(world, 90);
    EXPECT_GT(p_ball->getPosition().y(), 14) << "let go";
  });
}

TEST(Sandbox, MajorityTurnsGravityAndKeysAddBodies) {
  hostGame(sandbox_main, 1, [](df::World& world) {
    const std::uint32_t ann = world.input().join("ann", df::RED);
    world.input().join("bob", df::GREEN);
    tick(world, 10);
    const std::size_t count = bodies(world).size();
    tap(world, ann, df::Keyboard::R);
    tick(world, 2);
    EXPECT_EQ(bodies(world).size(), count + 10) << "a ragdoll";
    tap(world, ann, df::Keyboard::G);
    tick(world, 15);
    EXPECT_GT(PM.getGravity().y(), 0) << "one of two is not more than half";
    const std::uint32_t bob = 2;
    tap(world, bob, df::Keyboard::G);
    tick(world, 15);
    EXPECT_LT(PM.getGravity().x(), 0) << "to the left";
    tick(world, 60);
    int on_the_left = 0;
    for (const df::Body* p_body : bodies(world)) on_the_left += p_body->getPosition().x() < 40 ? 1 : 0;
    EXPECT_GT(on_the_left, 20);
  });
}

}  // namespace
}  // namespace naiad
