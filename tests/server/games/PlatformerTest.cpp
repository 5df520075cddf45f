#include <gtest/gtest.h>

#include "GameMains.h"
#include "HostedGame.h"

namespace naiad {
namespace {

using namespace df;

/// Returns the keys to run to the right, and to jump in front of steps, gaps and spikes.
std::set<Keyboard::Key> run(const Object& runner) {
  const Vector at = runner.getPosition();
  const bool step = isThere(Box(at + Vector(0.6, -0.3), 1, 0.6), "Ground");
  const bool gap = !isThere(Box(at + Vector(0.3, 0.6), 0.9, 1), "Ground");
  const bool sharp = isThere(Box(at + Vector(0.6, -0.3), 1.5, 0.6), "Spikes");
  if (step || gap || sharp) return {Keyboard::RIGHTARROW, Keyboard::SPACE};
  return {Keyboard::RIGHTARROW};
}

TEST(Platformer, JumpingBotReachesTheFlag) {
  hostGame(platformer_main, 1, [](World& world) {
    const std::uint32_t ann = joinAnn(world, 2);
    Fingers fingers(world, ann);
    int t = 0;
    for (; t < 600 && world.views().player(ann)->getScore() < 100; ++t) {
      const Object* p_runner = world.views().player(ann)->getObject();
      if (p_runner != nullptr) fingers.hold(run(*p_runner));
      world.tick();
    }
    EXPECT_GE(world.views().player(ann)->getScore(), 100) << world.picture().renderPlayer(ann).text();
    world.tick();
    EXPECT_NE(world.picture().renderPlayer(ann).text().find("reached the flag"), std::string::npos);
    tick(world, 2);
    EXPECT_LT(world.views().player(ann)->getObject()->getPosition().x(), 10);
  });
}

TEST(Platformer, JumpReachesFiveRowsAndLandsExactly) {
  hostGame(platformer_main, 1, [](World& world) {
    const std::uint32_t ann = joinAnn(world, 40);
    const Object* p_runner = world.views().player(ann)->getObject();
    const double ground = p_runner->getPosition().y();
    EXPECT_NEAR(ground, 19.05, 1e-6);  // half of its height of 0.9 above the ground, whose upper edge is at
                                       // 19.5
    EXPECT_EQ(p_runner->getVelocity(), Vector());
    EXPECT_EQ(p_runner->getAcceleration(), Vector());
    tap(world, ann, Keyboard::SPACE);
    double highest = ground;
    for (int t = 0; t < 40; ++t) {
      world.tick();
      highest = std::min(highest, p_runner->getPosition().y());
    }
    EXPECT_GT(ground - highest, 5.2);
    EXPECT_LT(ground - highest, 6);
    EXPECT_NEAR(p_runner->getPosition().y(), ground, 1e-6);
  });
}

TEST(Platformer, NoPlayerSticksToAWall) {
  hostGame(platformer_main, 1, [](World& world) {
    const std::uint32_t ann = joinAnn(world, 2);
    Object* p_runner = world.views().player(ann)->getObject();
    p_runner->setPosition(Vector(34.5, 19.6));  // in a gap, left of the wall at its far side
    Fingers fingers(world, ann);
    int t = 0;
    for (; t < 30 && p_runner->getPosition().x() > 30; ++t) {
      fingers.hold({Keyboard::RIGHTARROW});
      world.tick();
      if (p_runner->getPosition().y() < 21) {
        ASSERT_LT(p_runner->getPosition().x(), 36.5) << "through the wall";
      }
    }
    EXPECT_LT(t, 30) << "it falls along the wall and out of the world, and begins again";
  });
}

TEST(Platformer, PlayersCanStandOnEachOther) {
  hostGame(platformer_main, 1, [](World& world) {
    const std::uint32_t ann = world.input().join("ann", RED);
    const std::uint32_t bob = world.input().join("bob", GREEN);
    tick(world, 40);
    Object* p_ann = world.views().player(ann)->getObject();
    Object* p_bob = world.views().player(bob)->getObject();
    p_ann->setPosition(p_bob->getPosition() + Vector(0, -3));
    tick(world, 40);
    EXPECT_NEAR(p_ann->getPosition().y(), p_bob->getPosition().y() - 0.9, 1e-6);
  });
}

TEST(Platformer, CollectedCoinsReappear) {
  hostGame(platformer_main, 1, [](World& world) {
    const std::uint32_t ann = joinAnn(world, 40);
    Fingers fingers(world, ann);
    for (int t = 0; t < 15; ++t) {
      fingers.hold({Keyboard::RIGHTARROW});
      world.tick();
    }
    EXPECT_EQ(world.views().player(ann)->getScore(), 10);
    fingers.hold({});
    tick(world, 460);
    EXPECT_EQ(world.views().player(ann)->getScore(), 10);
    for (int t = 0; t < 15; ++t) {
      fingers.hold({Keyboard::LEFTARROW});
      world.tick();
    }
    EXPECT_EQ(world.views().player(ann)->getScore(), 20);
  });
}

}  // namespace
}  // namespace naiad
