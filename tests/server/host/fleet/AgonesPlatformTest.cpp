#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <stop_token>
#include <string>
#include <thread>

#include "FakeSidecar.h"
#include "host/fleet/AgonesPlatform.h"

namespace naiad {
namespace {

using namespace std::chrono_literals;
using test::FakeSidecar;

const std::string kServer =
    R"({"object_meta":{"name":"naiad-x7"},"spec":{"health":{"period_seconds":1}},)"
    R"("status":{"state":"Ready","address":"192.0.2.7","ports":[{"name":"default","port":7012}]}})";

std::pair<int, std::string> well(const std::string& request) {
  return {200, request == "GET /gameserver" ? kServer : "{}"};
}

/// A server that ticks while this exists. After half a second without ticks it would not count as healthy.
class Ticks {
 public:
  explicit Ticks(AgonesPlatform& platform)
      : m_thread([&platform](const std::stop_token& stop) {
          for (; !stop.stop_requested(); std::this_thread::sleep_for(33ms))
            platform.notifyTick(AgonesPlatform::Clock::now());
        }) {}

 private:
  std::jthread m_thread;
};

TEST(AgonesPlatform, RetriesUntilALateAndBusySidecarAnswers) {
  FakeSidecar sidecar;
  AgonesPlatform platform(sidecar.port());
  platform.notifyReady();
  std::string news;
  while (news.empty()) news = platform.popLogMessage();  // the connection was refused at least once
  EXPECT_EQ(news, "warning: Agones: the sidecar does not answer; trying again");
  std::atomic<int> asked = 0;
  sidecar.start([&](const std::string& request) {
    if (request == "POST /ready {}" && asked++ < 2) return std::pair<int, std::string>{503, "starting"};
    return well(request);
  });
  EXPECT_TRUE(sidecar.waitFor("POST /ready {}", 3));
  EXPECT_TRUE(sidecar.waitFor("GET /gameserver"));
  news.clear();
  while (news.find("players reach") == std::string::npos) news += platform.popLogMessage();
  ASSERT_TRUE(platform.address());
  EXPECT_EQ(platform.address()->host, "192.0.2.7");
  EXPECT_EQ(platform.address()->port, 7012);
  EXPECT_NE(news.find("players reach naiad-x7 at 192.0.2.7:7012"), std::string::npos) << news;
}

TEST(AgonesPlatform, SendsPlayerCountAndListAndHealthOnTicks) {
  FakeSidecar sidecar;
  sidecar.start(well);
  AgonesPlatform platform(sidecar.port());
  platform.notifyReady();
  platform.notifyPlayers({"", {3, 17}, 64});
  EXPECT_TRUE(sidecar.waitFor(R"(PATCH /v1beta1/lists/players {"capacity":"64","values":["3","17"]})"));
  EXPECT_TRUE(sidecar.waitFor(R"(PATCH /v1beta1/counters/players {"count":"2","capacity":"64"})"));
  EXPECT_TRUE(sidecar.waitFor("POST /allocate {}"));
  const auto requests = sidecar.requests();
  EXPECT_EQ(std::ranges::count(requests, "POST /health {}"), 0) << "no tick yet";
  const Ticks ticks(platform);
  EXPECT_TRUE(sidecar.waitFor("POST /health {}"));
}

TEST(AgonesPlatform, FinishSendsShutdownBeforeReturning) {
  FakeSidecar sidecar;
  sidecar.start(well);
  AgonesPlatform platform(sidecar.port());
  platform.notifyReady();
  platform.finish(60s);
  EXPECT_EQ(sidecar.requests().back(), "POST /shutdown {}");
}

TEST(AgonesPlatform, FinishWithoutASidecarTimesOut) {
  FakeSidecar sidecar;  // refuses connections until start()
  const auto begin = std::chrono::steady_clock::now();
  {
    AgonesPlatform platform(sidecar.port());
    platform.notifyReady();
    platform.finish(200ms);
  }
  EXPECT_LT(std::chrono::steady_clock::now() - begin, 30s);
}

TEST(AgonesPlatform, WatchReportsShutdownAfterReconnectAndInPieces) {
  FakeSidecar sidecar;
  sidecar.start(well);
  AgonesPlatform platform(sidecar.port());
  ASSERT_TRUE(sidecar.waitFor("GET /watch/gameserver"));
  sidecar.push("{\"result\":" + kServer + "}\n", 7);
  sidecar.push("nonsense\n");
  EXPECT_FALSE(platform.popShutdownRequest());
  sidecar.endWatches();
  ASSERT_TRUE(sidecar.waitFor("GET /watch/gameserver", 2));
  sidecar.push(R"({"result":{"status":{"state":"Shutdown"}}})"
               "\n",
               5);
  while (!platform.popShutdownRequest()) {
  }
  EXPECT_FALSE(platform.popShutdownRequest()) << "once";
}

TEST(AgonesPlatform, WatchWithOversizedLineIsReconnected) {
  FakeSidecar sidecar;
  sidecar.start(well);
  AgonesPlatform platform(sidecar.port());
  ASSERT_TRUE(sidecar.waitFor("GET /watch/gameserver"));
  sidecar.push(std::string(GameServerInfo::kMaxBytes + 1, 'x'), 60'000);
  EXPECT_TRUE(sidecar.waitFor("GET /watch/gameserver", 2));
}

}  // namespace
}  // namespace naiad
