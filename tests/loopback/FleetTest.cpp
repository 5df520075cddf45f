// dfserver in a fleet: its messages to the sidecar of a cluster and to the bus. Players do not notice when
// the sidecar or the bus disappears. Real processes and sockets, a fake sidecar, the real nats-server.
#include <gtest/gtest.h>
#include <signal.h>

#include <map>
#include <memory>
#include <string>

#include "ProgramFixture.h"
#include "tests/server/host/fleet/FakeSidecar.h"
#include "tests/server/host/fleet/NatsServer.h"

namespace naiad::test {
namespace {

class Fleet : public ProgramFixture {
 protected:
  void start(std::map<std::string, std::string> environment) {
    environment["NAIAD_GAME"] = "hello";
    launch("dfserver", std::move(environment));
  }
};

std::pair<int, std::string> answerWell(const std::string& request) {
  return {200, request == "GET /gameserver" ? R"({"spec":{"health":{"period_seconds":1}}})" : "{}"};
}

TEST_F(Fleet, ServerReportsReadyHealthAllocateAndShutdown) {
  FakeSidecar sidecar;
  sidecar.start(answerWell);
  start({{"AGONES_SDK_HTTP_PORT", std::to_string(sidecar.port())}});
  EXPECT_TRUE(sidecar.waitFor("POST /ready {}"));
  EXPECT_TRUE(sidecar.waitFor("POST /health {}", 3));
  auto ann = join("ann");
  EXPECT_TRUE(sidecar.waitFor("POST /allocate {}"));
  EXPECT_TRUE(sidecar.waitFor(R"(PATCH /v1beta1/lists/players {"capacity":"64","values":["1"]})"));
  clients.clear();
  ann.reset();
  game->end(SIGTERM);
  EXPECT_EQ(sidecar.requests().back(), "POST /shutdown {}");
  EXPECT_TRUE(has(game->log(), "platform_requests="));
}

TEST_F(Fleet, ImmediateStopAlsoReportsShutdown) {
  FakeSidecar sidecar;
  sidecar.start(answerWell);
  start({{"AGONES_SDK_HTTP_PORT", std::to_string(sidecar.port())}, {"NAIAD_DRAIN_TIMEOUT", "1000"}});
  auto ann = join("ann");
  game->signal(SIGTERM);
  EXPECT_TRUE(waitForLog("stopping when all players have left"));
  game->end(SIGTERM);
  EXPECT_EQ(sidecar.requests().back(), "POST /shutdown {}");
}

TEST_F(Fleet, ClusterShutdownDrainsTheServer) {
  FakeSidecar sidecar;
  sidecar.start(answerWell);
  start({{"AGONES_SDK_HTTP_PORT", std::to_string(sidecar.port())},
         {"NAIAD_DRAIN_TIMEOUT", "1000"},
         {"NAIAD_RECONNECT_TIME", "0"}});
  ASSERT_TRUE(sidecar.waitFor("GET /watch/gameserver"));
  auto ann = join("ann");
  sidecar.push(R"({"result":{"status":{"state":"Shutdown"}}})"
               "\n");
  EXPECT_TRUE(waitForLog("the platform requested a shutdown"));
  EXPECT_TRUE(ann->joined()) << "ann plays on";
  clients.clear();
  ann.reset();
  EXPECT_EQ(game->wait(), 0);
}

TEST_F(Fleet, LostSidecarDoesNotDisturbPlayers) {
  auto sidecar = std::make_unique<FakeSidecar>();
  sidecar->start(answerWell);
  start({{"AGONES_SDK_HTTP_PORT", std::to_string(sidecar->port())}});
  auto ann = join("ann");
  sidecar.reset();
  EXPECT_TRUE(waitForLog("warning: Agones: the sidecar does not answer"));
  EXPECT_TRUE(waitForTicks(*ann, 200)) << "the game continues";
  EXPECT_EQ(ann->session().counters().resets, 0u);
}

TEST_F(Fleet, KilledBusDisturbsNoPlayerAndIsReconnected) {
  if (!NatsServer::isInstalled()) GTEST_SKIP() << "nats-server is not installed";
  NatsServer bus;
  ASSERT_TRUE(bus.start()) << bus.log();
  start({{"NAIAD_BUS", bus.url()}, {"NAIAD_BUS_ID", "berlin"}, {"NAIAD_BUS_INTERVAL", "100"}});
  auto ann = join("ann");
  if (game->log().find("without NATS") != std::string::npos) GTEST_SKIP() << "built without libnats";
  EXPECT_TRUE(waitForLog("the bus is connected"));
  bus.kill();
  EXPECT_TRUE(waitForLog("warning: the bus cannot be reached"));
  EXPECT_TRUE(waitForTicks(*ann, 200)) << "the game continues";
  ASSERT_TRUE(bus.start()) << bus.log();
  const std::size_t before = game->log().size();
  EXPECT_TRUE(serve([&] {
    return game->log().find("the bus is connected", game->log().find("cannot be reached")) !=
           std::string::npos;
  })) << game->log().substr(before);
  EXPECT_EQ(ann->session().counters().resets, 0u);
  EXPECT_FALSE(has(game->log(), "reconnected")) << "ann had to come back";
  game->end(SIGTERM);
  EXPECT_TRUE(has(game->log(), "bus_connections=2"));
}

}  // namespace
}  // namespace naiad::test
