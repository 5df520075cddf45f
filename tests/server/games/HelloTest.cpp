#include <gtest/gtest.h>

#include "GameMains.h"
#include "HostedGame.h"
#include "utility.h"

namespace naiad {
namespace {

TEST(Hello, WallsAndOtherWalkersBlock) {
  hostGame(hello_main, 1, [](df::World& world) {
    const std::uint32_t ann = world.input().join("ann", df::RED);
    const std::uint32_t bob = world.input().join("bob", df::GREEN);
    for (int t = 0; t < 120; ++t) {
      tap(world, ann, df::Keyboard::LEFTARROW);
      if (t % 2 == 0) tap(world, ann, df::Keyboard::UPARROW);
      world.tick();
    }
    for (int t = 0; t < 120; ++t) {
      tap(world, bob, df::Keyboard::LEFTARROW);
      tap(world, bob, df::Keyboard::UPARROW);
      world.tick();
    }
    const df::Vector of_ann = world.views().player(ann)->getObject()->getPosition();
    const df::Vector of_bob = world.views().player(bob)->getObject()->getPosition();
    EXPECT_EQ(of_ann.x(), 1);
    EXPECT_EQ(df::distance(of_ann, of_bob), 1);
    const df::Canvas canvas = world.picture().renderPlayer(ann);
    EXPECT_EQ(canvas.at(1, static_cast<int>(of_ann.y())), (df::Cell{U'@', df::RED}));
    EXPECT_EQ(canvas.at(0, 0).ch, U'#');
  });
}

TEST(Hello, WalkerLeavesWithItsPlayer) {
  hostGame(hello_main, 1, [](df::World& world) {
    const std::uint32_t ann = world.input().join("ann", df::RED);
    const std::uint32_t bob = world.input().join("bob", df::GREEN);
    world.tick();
    const int objects = world.store().countInWorld();
    world.input().leave(ann);
    tap(world, bob, df::Keyboard::UPARROW);  // ann's walker gets this event, too, in its last tick
    world.tick();
    EXPECT_EQ(world.store().countInWorld(), objects - 1);
  });
}

}  // namespace
}  // namespace naiad
