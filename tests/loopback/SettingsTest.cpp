// The tick length that a game requests is told to its clients.
#include <gtest/gtest.h>

#include "TestClient.h"
#include "TestServer.h"
#include "engine/world/WorldExtras.h"

namespace naiad::test {
namespace {

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
