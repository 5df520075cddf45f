// The ticks that a new player is told: their length, and their number on a server that was empty for long.
#include <gtest/gtest.h>

#include "BusyWorld.h"
#include "Compare.h"
#include "engine/world/WorldExtras.h"

namespace naiad::test {
namespace {

/// Ticks before the first player joins: between half the range of 16 bits and all of it, here 22 minutes at
/// 30 Hz.
constexpr std::uint32_t kEmptyTicks = 40'000;

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

std::chrono::microseconds tickToldWith(int frame_time_millis, int frame_micros) {
  HostOptions options = fastOptions();
  options.frame_micros = frame_micros;
  TestServer server([=](df::World& world) { world.extras().settings.frame_time = frame_time_millis; },
                    options);
  asio::io_context context;
  TestClient client(context, server.port(), "ann");
  EXPECT_TRUE(serveUntil(context, {&client}, [&] { return client.joined(); }));
  return client.session().welcome().tick;
}

TEST(Settings, WelcomeHasFrameTimeOfGameOrHost) {
  EXPECT_EQ(tickToldWith(5, 0), std::chrono::milliseconds(5));
  EXPECT_EQ(tickToldWith(50, 3000), std::chrono::milliseconds(3)) << "the host's own counts more";
  EXPECT_EQ(tickToldWith(33, 0), std::chrono::microseconds(33333))
      << "33 is how the published engine writes 1/30 s";
  EXPECT_EQ(tickToldWith(999999, 0), std::chrono::seconds(1)) << "clients believe no longer one";
}

}  // namespace
}  // namespace naiad::test
