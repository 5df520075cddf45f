#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <string>
#include <vector>

#include "FakeSidecar.h"
#include "host/fleet/AgonesPlatform.h"
#include "host/fleet/AgonesRequestScheduler.h"

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
  sidecar.push(std::string(GameServerInfo::kMaxBytes + 1, 'x'), 60'000);
  ASSERT_TRUE(sidecar.waitFor("GET /watch/gameserver", 2)) << "after a line that is too long";
  sidecar.endWatches();
  ASSERT_TRUE(sidecar.waitFor("GET /watch/gameserver", 3));
  sidecar.push(R"({"result":{"status":{"state":"Shutdown"}}})"
               "\n",
               5);
  while (!platform.popShutdownRequest()) {
  }
  EXPECT_FALSE(platform.popShutdownRequest()) << "once";
}

using Time = AgonesRequestScheduler::Time;

/// A server's duties, and a sidecar that answers as the test says.
class AgonesRequestSchedulerTest : public testing::Test {
 protected:
  /// Returns all requests that are due now, after answering each with this status and body.
  std::vector<std::string> said(int status = 200, const std::string& body = "{}") {
    std::vector<std::string> all;
    while (const auto request = duties.next(now)) {
      all.push_back(request->method + " " + request->path);
      bodies.push_back(request->body);
      duties.onResponse(status, body, now);
    }
    return all;
  }
  void play(std::vector<std::uint32_t> ids) { duties.setPlayers({"", std::move(ids), 64}); }
  using All = std::vector<std::string>;

  AgonesRequestScheduler duties;
  Time now{1000s};
  std::vector<std::string> bodies;
};

TEST_F(AgonesRequestSchedulerTest, SaysNothingBeforeTheServerIsReady) {
  duties.onTick(now);
  EXPECT_EQ(said(), All{});
  duties.setReady();
  play({});
  EXPECT_EQ(said(), (All{"POST /health", "POST /ready", "GET /gameserver", "PATCH /v1beta1/counters/players",
                         "PATCH /v1beta1/lists/players"}));
  EXPECT_EQ(bodies[3], R"({"count":"0","capacity":"64"})");
  EXPECT_EQ(bodies[4], R"({"capacity":"64","values":[]})");
  EXPECT_EQ(said(), All{});
}

TEST_F(AgonesRequestSchedulerTest, SendsOneRequestAtATimeAndRetriesLater) {
  duties.setReady();
  ASSERT_TRUE(duties.next(now));
  EXPECT_FALSE(duties.next(now + 1h)) << "no answer yet";
  duties.onResponse(503, "", now);
  EXPECT_FALSE(duties.next(now));
  EXPECT_EQ(duties.wake(), now + AgonesRequestScheduler::kRetryInterval);
  now = duties.wake();
  ASSERT_TRUE(duties.next(now));
  duties.onResponse(0, "", now);
  now += AgonesRequestScheduler::kRetryInterval;
  EXPECT_EQ(said().front(), "POST /ready");
  EXPECT_EQ(duties.counters().failures, 2u);
}

TEST_F(AgonesRequestSchedulerTest, IsHealthyAsLongAsItTicks) {
  duties.setReady();
  duties.onTick(now);
  said();
  for (int i = 0; i < 4; ++i) {
    now += AgonesRequestScheduler::kHealth;
    duties.onTick(now - 1ms);
    EXPECT_EQ(said(), All{"POST /health"});
  }
  now += 10s;  // the server hangs
  EXPECT_EQ(said(), All{});
  EXPECT_EQ(duties.counters().health, 5u);
}

TEST_F(AgonesRequestSchedulerTest, HealthIntervalComesFromTheSidecar) {
  duties.setReady();
  duties.onTick(now);
  said(200, R"({"spec":{"health":{"period_seconds":2}}})");
  now += 1s;
  duties.onTick(now);
  EXPECT_EQ(said(), All{"POST /health"});
}

TEST_F(AgonesRequestSchedulerTest, IsAllocatedWithPlayersAndReadyWithoutThem) {
  duties.setReady();
  said();
  bodies.clear();
  play({3, 17});
  EXPECT_EQ(said(),
            (All{"POST /allocate", "PATCH /v1beta1/counters/players", "PATCH /v1beta1/lists/players"}));
  EXPECT_EQ(bodies[1], R"({"count":"2","capacity":"64"})");
  EXPECT_EQ(bodies[2], R"({"capacity":"64","values":["3","17"]})");
  play({17});
  EXPECT_EQ(said(), (All{"PATCH /v1beta1/counters/players", "PATCH /v1beta1/lists/players"}));
  play({});
  EXPECT_EQ(said().front(), "POST /ready");
}

TEST_F(AgonesRequestSchedulerTest, PlayerListIsLimitedTo1000Ids) {
  duties.setReady();
  std::vector<std::uint32_t> ids;
  for (std::uint32_t id = 1; id <= 1500; ++id) ids.push_back(id);
  duties.setPlayers({"", ids, 2000});
  said();
  EXPECT_EQ(bodies[bodies.size() - 2], R"({"count":"1500","capacity":"2000"})");
  EXPECT_NE(bodies.back().find(R"("1000"])"), std::string::npos);
  EXPECT_EQ(bodies.back().find("1001"), std::string::npos);
}

TEST_F(AgonesRequestSchedulerTest, MissingCountersAndListsAreNotRetried) {
  duties.setReady();
  play({});
  for (int i = 0; i < 10; ++i) {
    const auto request = duties.next(now);
    if (!request) break;
    duties.onResponse(request->path.find("v1beta1") != std::string::npos ? 404 : 200, "{}", now);
  }
  EXPECT_FALSE(duties.next(now));
  EXPECT_EQ(duties.missing(), "/v1beta1/counters/players, /v1beta1/lists/players");
  EXPECT_EQ(duties.counters().failures, 0u);
}

// An unusable answer: too long, truncated, or from another program on that port.
TEST_F(AgonesRequestSchedulerTest, InvalidServerInfoIsRetriedWithoutBlockingOtherDuties) {
  const std::string server = R"({"status":{"address":"192.0.2.7","ports":[{"port":7012}]}})";
  for (const std::string& body :
       {"{" + std::string(GameServerInfo::kMaxBytes, ' ') + "}", server.substr(0, 30), std::string("[]")}) {
    const std::uint64_t failures = duties.counters().failures;
    duties.setReady();
    play({});
    const All all = said(200, body);
    EXPECT_EQ(std::ranges::count(all, "GET /gameserver"), 1);
    EXPECT_EQ(duties.counters().failures, failures + 1);
    EXPECT_FALSE(duties.facts());
    EXPECT_EQ(duties.wake(), now + AgonesRequestScheduler::kRetryInterval);
    now = duties.wake();
  }
  EXPECT_EQ(bodies[2], R"({"count":"0","capacity":"64"})") << "what it does not hinder";
  EXPECT_EQ(said(200, server), All{"GET /gameserver"});
  ASSERT_TRUE(duties.facts());
  EXPECT_EQ(duties.facts()->port, 7012);
}

TEST_F(AgonesRequestSchedulerTest, ShutdownIsSentFirstAndEndsAllRequests) {
  duties.setReady();
  duties.onTick(now);
  play({1});
  duties.setEnding();
  ASSERT_EQ(duties.next(now)->path, "/shutdown");
  duties.onResponse(503, "", now);
  EXPECT_FALSE(duties.isOver());
  now += AgonesRequestScheduler::kRetryInterval;
  EXPECT_EQ(said(), All{"POST /shutdown"});
  EXPECT_TRUE(duties.isOver());
  now += 1h;
  EXPECT_EQ(said(), All{});
}

TEST(GameServerInfo, ReadsKnownFieldsAndIgnoresTheRest) {
  const std::string server =
      R"({"object_meta":{"name":"naiad-x7","labels":{"a":"b"}},"spec":{"health":{"period_seconds":5}},)"
      R"("status":{"state":"Allocated","address":"192.0.2.7","ports":[{"name":"default","port":7012},{"port":1}]}})";
  const auto facts = GameServerInfo::parse(server, false);
  ASSERT_TRUE(facts);
  EXPECT_EQ(facts->name, "naiad-x7");
  EXPECT_EQ(facts->state, "Allocated");
  EXPECT_EQ(facts->address, "192.0.2.7");
  EXPECT_EQ(facts->port, 7012);
  EXPECT_EQ(facts->health_seconds, 5);
  EXPECT_EQ(GameServerInfo::parse(R"({"result":)" + server + "}", true)->state, "Allocated");
  EXPECT_FALSE(GameServerInfo::parse(server, true));
  EXPECT_FALSE(GameServerInfo::parse(R"({"error":{"http_code":500}})", true));
}

TEST(GameServerInfo, InvalidJsonIsRejectedAndInvalidFieldsAreEmpty) {
  for (const std::string& text : {std::string(), std::string("{"), std::string("[]"), std::string("7"),
                                  std::string(100'000, '['), std::string("{\"a\":\xff}")})
    EXPECT_FALSE(GameServerInfo::parse(text, false)) << text.substr(0, 20);
  const auto facts = GameServerInfo::parse(
      R"({"object_meta":7,"spec":[],"status":{"state":["Ready"],"address":"a\nb","ports":[{"port":70000}]}})",
      false);
  ASSERT_TRUE(facts);
  EXPECT_EQ(facts->name + facts->state + facts->address, "");
  EXPECT_EQ(facts->port, 0);
  for (const std::string port : {"-1", "0", "1.5", "\"80\"", "18446744073709551615"})
    EXPECT_EQ(GameServerInfo::parse(R"({"status":{"ports":[{"port":)" + port + "}]}}", false)->port, 0)
        << port;
  EXPECT_FALSE(GameServerInfo::parse("{" + std::string(GameServerInfo::kMaxBytes, ' ') + "}", false));
}

}  // namespace
}  // namespace naiad
