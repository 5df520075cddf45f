#include <gtest/gtest.h>

#include "GameMains.h"
#include "HostedGame.h"
#include "utility.h"

namespace naiad {
namespace {

using namespace df;

/// Runs to the nearest gold, and does not avoid hounds.
std::set<Keyboard::Key> greedy(const World& world, const Object& hare) {
  const Vector at = hare.getPosition();
  const Object* p_best = nullptr;
  const ObjectList gold = world.objects().objectsOfType("Gold");
  for (int i = 0; i < gold.getCount(); ++i) {
    if (p_best == nullptr || distance(at, gold[i]->getPosition()) < distance(at, p_best->getPosition()))
      p_best = gold[i];
  }
  const Vector way = p_best->getPosition() - at;
  std::set<Keyboard::Key> keys;
  if (std::abs(way.x()) >= 0.5) keys.insert(way.x() > 0 ? Keyboard::RIGHTARROW : Keyboard::LEFTARROW);
  if (std::abs(way.y()) >= 0.5) keys.insert(way.y() > 0 ? Keyboard::DOWNARROW : Keyboard::UPARROW);
  return keys;
}

TEST(Chase, AGreedyBotGathersTenPiecesOfGold) {
  hostGame(chase_main, 1, [](World& world) {
    const std::uint32_t ann = joinAnn(world);
    Fingers fingers(world, ann);
    int best = 0;
    for (int t = 0; t < 3000 && best < 100; ++t) {
      fingers.hold(greedy(world, *world.views().player(ann)->getObject()));
      world.tick();
      best = std::max(best, world.views().player(ann)->getScore());
    }
    EXPECT_GE(best, 100);
  });
}

TEST(Chase, HoundsCatchAnIdlePlayerAndTakeHalf) {
  hostGame(chase_main, 1, [](World& world) {
    const std::uint32_t ann = joinAnn(world);
    world.views().player(ann)->setScore(40);
    for (int t = 0; t < 1500 && world.views().player(ann)->getScore() >= 40; ++t) world.tick();
    EXPECT_LT(world.views().player(ann)->getScore(), 40);
    EXPECT_GE(world.views().player(ann)->getScore(), 20);
  });
}

TEST(Chase, MoreGoldBringsMoreHounds) {
  hostGame(chase_main, 1, [](World& world) {
    const std::uint32_t ann = joinAnn(world, 2);
    EXPECT_EQ(world.objects().objectsOfType("Hound").getCount(), 3);
    world.views().player(ann)->setScore(100);
    tick(world, 3);
    EXPECT_EQ(world.objects().objectsOfType("Hound").getCount(), 5);
    world.input().leave(ann);
    tick(world, 5);
    EXPECT_EQ(world.objects().objectsOfType("Hound").getCount(), 3);
    EXPECT_EQ(world.objects().objectsOfType("Hare").getCount(), 0);
  });
}

}  // namespace
}  // namespace naiad
