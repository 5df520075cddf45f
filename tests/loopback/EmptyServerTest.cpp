// The first player on a server that was empty for long. Ticks without players also count.
#include <gtest/gtest.h>

#include "TestClient.h"
#include "TestServer.h"
#include "engine/managers/DisplayManager.h"
#include "engine/world/Object.h"
#include "host/world/WorldInProcess.h"

namespace naiad::test {
namespace {

/// Ticks before the first player joins: between half the range of 16 bits and all of it, here 22 minutes at
/// 30 Hz.
constexpr std::uint32_t kEmptyTicks = 40'000;

/// An object that moves, so that a picture of a wrong tick shows it in a wrong place.
struct Walker : df::Object {
  Walker() {
    setSolidness(df::SPECTRAL);
    setPosition(df::Vector(1, 5));
    setVelocity(df::Vector(0.05F, 0));
  }
  int draw() override { return DM.drawCh(getPosition(), '@', df::CYAN); }
};

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
    for (std::uint32_t i = 0; i < kEmptyTicks; ++i) world.tick();
    new Walker;
  });
  asio::io_context context;
  TestClient ann(context, server.port(), "ann");
  ASSERT_TRUE(serveUntil(context, {&ann}, [&] { return ann.joined() && ann.pictures().size() >= 30; }));
  int compared = 0;
  for (const auto& [tick, picture] : ann.pictures()) {
    EXPECT_GT(tick, kEmptyTicks);
    EXPECT_LT(tick, kEmptyTicks + 20'000);
    const auto truth = server.truth(tick, ann.player());
    if (!truth) continue;
    ++compared;
    EXPECT_EQ(picture.text(), truth->text()) << "tick " << tick;
  }
  EXPECT_GE(compared, 20);
}

}  // namespace
}  // namespace naiad::test
