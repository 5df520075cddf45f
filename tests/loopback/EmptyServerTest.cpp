// The first player on a server that was empty for long. Ticks without players also count.
#include <gtest/gtest.h>

#include "BusyWorld.h"
#include "Compare.h"
#include "host/world/WorldInProcess.h"

namespace naiad::test {
namespace {

/// Ticks before the first player joins: between half the range of 16 bits and all of it, here 22 minutes at
/// 30 Hz.
constexpr std::uint32_t kEmptyTicks = 40'000;

TEST(EmptyServer, TicksWithoutPlayersAreCounted) {
  df::World world;
  const df::World::Scope scope(world);
  WorldInProcess port(world);
  EXPECT_EQ(port.nextTick(), 1u);
  SentTurn turn;
  for (int i = 0; i < 5; ++i) port.tick(turn);
  EXPECT_EQ(port.nextTick(), 6u);
  turn.turn.watched = true;
  port.tick(turn);
  EXPECT_EQ(port.view().tick, 6u);
  EXPECT_EQ(port.nextTick(), 7u);
}

TEST(EmptyServer, PlayerJoiningAfterHalfAnHourSeesCurrentTicks) {
  TestServer server([](df::World& world) {
    populateBusyWorld(world, 5);
    for (std::uint32_t i = 0; i < kEmptyTicks; ++i) world.tick();
  });
  asio::io_context context;
  TestClient ann(context, server.port(), "ann");
  ASSERT_TRUE(serveUntil(context, {&ann}, [&] { return ann.joined() && ann.pictures().size() >= 30; }));
  EXPECT_GT(ann.pictures().begin()->first, kEmptyTicks);
  EXPECT_LT(ann.pictures().rbegin()->first, kEmptyTicks + 20'000);
  expectSame(ann, server, 20);
}

}  // namespace
}  // namespace naiad::test
