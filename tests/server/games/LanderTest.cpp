#include <gtest/gtest.h>

#include <cmath>

#include "GameMains.h"
#include "HighScores.h"
#include "HostedGame.h"

namespace naiad {
namespace {

/// Finds the middle of the nearest pad on the screen, as a pilot would.
std::optional<df::Vector> nearestPad(const df::Canvas& screen, double x) {
  std::optional<df::Vector> best;
  for (int row = 0; row < screen.height(); ++row) {
    for (int column = 0; column < screen.width(); ++column) {
      if (screen.at(column, row).ch != U'=') continue;
      int end = column;
      while (end < screen.width() && screen.at(end, row).ch == U'=') ++end;
      const df::Vector pad((column + end - 1) / 2.0, row);
      if (!best || std::abs(pad.x() - x) < std::abs(best->x() - x)) best = pad;
      column = end;
    }
  }
  return best;
}

/// Steers by position and speed: first across, then down, and slower near the ground.
void pilot(df::World& world, std::uint32_t player, df::Vector pad) {
  constexpr double kTicks = 30;
  const df::Object& ship = *world.views().player(player)->getObject();
  const df::Vector v = ship.getVelocity();
  const double aside = pad.x() - ship.getPosition().x();
  const double height = pad.y() - 1.5 - ship.getPosition().y();
  const double across = std::clamp(aside * 0.5, -2.5, 2.5) / kTicks;
  const double down = (std::abs(aside) > 1.5 ? 0 : std::clamp(height * 0.5, 1.0, 3.0)) / kTicks;
  if (v.y() > down) tap(world, player, df::Keyboard::UPARROW);
  if (v.x() > across + 0.01) tap(world, player, df::Keyboard::LEFTARROW);
  if (v.x() < across - 0.01) tap(world, player, df::Keyboard::RIGHTARROW);
}

TEST(Lander, GentlePilotEarnsPointsAndTheLandingIsStored) {
  hostGame(lander_main, 3, [](df::World& world) {
    world.input().push(
        {.kind = df::InputQueue::kScore, .player = 0, .name = "bob", .table = "landings", .points = 5000});
    const std::uint32_t ann = joinAnn(world);
    for (int t = 0; t < 1800 && world.views().player(ann)->getScore() == 0; ++t) {
      const auto pad = nearestPad(world.picture().renderPlayer(ann),
                                  world.views().player(ann)->getObject()->getPosition().x());
      ASSERT_TRUE(pad);
      pilot(world, ann, *pad);
      world.tick();
    }
    EXPECT_GE(world.views().player(ann)->getScore(), 50);
    EXPECT_TRUE(shows(world, ann, "The best landing: bob, 5000")) << world.picture().renderPlayer(ann).text();
    const auto best = df::HighScores("landings").best(2);
    ASSERT_EQ(best.size(), 2u);
    EXPECT_EQ(best[1], (df::HighScore{"ann", world.views().player(ann)->getScore()}));
  });
}

TEST(Lander, WithoutInputTheLanderCrashes) {
  hostGame(lander_main, 3, [](df::World& world) {
    const std::uint32_t ann = world.input().join("ann", df::RED);
    int longest = 0;
    for (int t = 0; t < 300 && longest == 0; ++t) {
      world.tick();
      if (world.views().player(ann)->getObject()->getSolidness() == df::SPECTRAL) longest = t;
    }
    EXPECT_GT(longest, 30) << "it fell for a while";
    tick(world, 100);
    EXPECT_EQ(world.views().player(ann)->getScore(), 0);
    EXPECT_EQ(world.views().player(ann)->getObject()->getSolidness(), df::HARD) << "a new ship";
  });
}

}  // namespace
}  // namespace naiad
