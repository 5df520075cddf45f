#include <gtest/gtest.h>

#include <vector>

#include "GameMains.h"
#include "HostedGame.h"

namespace naiad {
namespace {

using namespace df;

/// Moves the paddle towards the point at which the nearest ball will reach its side.
std::set<Keyboard::Key> follow(const World& world, const Object& paddle) {
  const Vector at = paddle.getPosition();
  const bool lies = paddle.getBox().getHorizontal() > paddle.getBox().getVertical();
  const Object* p_ball = nullptr;
  const auto gap = [&](const Object& ball) {
    const Vector way = ball.getPosition() - at;
    return lies ? std::abs(way.y()) : std::abs(way.x());
  };
  const ObjectList balls = world.objects().objectsOfType("Ball");
  for (int i = 0; i < balls.getCount(); ++i)
    if (p_ball == nullptr || gap(*balls[i]) < gap(*p_ball)) p_ball = balls[i];
  if (p_ball == nullptr) return {};
  const Vector way = p_ball->getPosition() - at;
  // Hits the ball off the paddle's middle, because the middle would always send it in one direction.
  const double aside = (world.getStepCount() / 90 % 5) - 2;
  if (lies && std::abs(way.x() + aside) > 1)
    return {way.x() + aside > 0 ? Keyboard::RIGHTARROW : Keyboard::LEFTARROW};
  if (!lies && std::abs(way.y() + aside / 2) > 0.6)
    return {way.y() + aside / 2 > 0 ? Keyboard::DOWNARROW : Keyboard::UPARROW};
  return {};
}

class BreakoutFor : public ::testing::TestWithParam<int> {};

TEST_P(BreakoutFor, BotsClearTheFirstLevel) {
  hostGame(breakout_main, 1, [](World& world) {
    std::vector<std::uint32_t> players;
    std::vector<Fingers> fingers;
    for (int i = 0; i < GetParam(); ++i) {
      players.push_back(world.input().join("bot", RED));
      fingers.emplace_back(world, players.back());
    }
    tick(world, 2);
    int t = 0;
    for (; t < 20'000 && !shows(world, players[0], "level 2"); ++t) {
      for (std::size_t i = 0; i < players.size(); ++i)
        fingers[i].hold(follow(world, *world.views().player(players[i])->getObject()));
      world.tick();
      const ObjectList balls = world.objects().objectsOfType("Ball");
      for (int i = 0; i < balls.getCount(); ++i) {
        const Vector at = balls[i]->getPosition();
        ASSERT_TRUE(at.x() > -2 && at.x() < 82 && at.y() > -2 && at.y() < 26) << "a ball is lost for ever";
      }
    }
    EXPECT_TRUE(shows(world, players[0], "level 2")) << "after " << t << " ticks";
    int points = 0;
    for (const std::uint32_t player : players) points += world.views().player(player)->getScore();
    EXPECT_GE(points, GetParam() == 1 ? 200 : 0) << "several get into each other's way";
    EXPECT_LE(points, 540);
  });
}

INSTANTIATE_TEST_SUITE_P(OneToFour, BreakoutFor, ::testing::Values(1, 2, 4));

TEST(Breakout, FifthPlayerWaitsForAFreeSide) {
  hostGame(breakout_main, 1, [](World& world) {
    std::vector<std::uint32_t> players;
    for (int i = 0; i < 5; ++i) players.push_back(world.input().join("bot", RED));
    tick(world, 3);
    EXPECT_EQ(world.objects().objectsOfType("Paddle").getCount(), 4);
    EXPECT_EQ(world.objects().objectsOfType("Wall").getCount(), 0);
    EXPECT_EQ(world.objects().objectsOfType("Ball").getCount(), 4);
    EXPECT_TRUE(shows(world, players[4], "all sides are taken"));
    world.input().leave(players[2]);
    tick(world, 3);
    EXPECT_EQ(world.objects().objectsOfType("Paddle").getCount(), 4);
    EXPECT_EQ(world.objects().objectsOfType("Ball").getCount(), 4);
    EXPECT_FALSE(shows(world, players[4], "all sides are taken"));
    ASSERT_NE(world.views().player(players[4])->getObject(), nullptr);
    for (const std::uint32_t player : {players[0], players[1], players[3]}) world.input().leave(player);
    tick(world, 3);
    EXPECT_EQ(world.objects().objectsOfType("Paddle").getCount(), 1);
    EXPECT_EQ(world.objects().objectsOfType("Wall").getCount(), 3);
  });
}

TEST(Breakout, PaddlesObeyTheKeysOfTheirSide) {
  hostGame(breakout_main, 1, [](World& world) {
    std::vector<Fingers> fingers;
    std::vector<std::uint32_t> players;
    for (int i = 0; i < 4; ++i)
      fingers.emplace_back(world, players.emplace_back(world.input().join("bot", RED)));
    tick(world, 2);
    std::vector<Vector> before;
    for (const std::uint32_t p : players)
      before.push_back(world.views().player(p)->getObject()->getPosition());
    for (int t = 0; t < 10; ++t) {
      for (Fingers& one : fingers) one.hold({Keyboard::RIGHTARROW, Keyboard::UPARROW});
      world.tick();
    }
    for (std::size_t i = 0; i < 4; ++i) {
      const Vector way = world.views().player(players[i])->getObject()->getPosition() - before[i];
      const bool lies = i < 2;
      EXPECT_TRUE(lies ? way.x() > 8 && way.y() == 0 : way.x() == 0 && way.y() < -4) << i;
    }
  });
}

}  // namespace
}  // namespace naiad
