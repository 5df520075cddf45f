// The metrics page (--metrics) of a server with players. Real sockets.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <list>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "LoopbackFixture.h"
#include "engine/events/EventStep.h"
#include "engine/world/Object.h"
#include "shared/values/SplitMix64.h"
#include "tests/support/net/HttpClient.h"

namespace naiad::test {
namespace {

HostOptions withMetrics() {
  HostOptions options = fastOptions();
  options.metrics = "127.0.0.1:0";
  return options;
}

class Metrics : public LoopbackFixture {
 protected:
  void start(const std::function<void(df::World&)>& populate, const HostOptions& options = withMetrics()) {
    server = std::make_unique<TestServer>(populate, options);
    server->keepTruth(false);
    ASSERT_NE(server->metricsPort(), 0);
  }
  TestClient& join(const std::string& name) {
    clients.emplace_back(context, server->port(), name);
    clients.back().keepPictures(false);
    TestClient& client = clients.back();
    EXPECT_TRUE(serve([&client] { return client.joined() && client.newestTick() > 0; }));
    return client;
  }
  /// Serves the clients until `done` returns true; false after kPatience.
  bool serve(const std::function<bool()>& done) {
    std::vector<TestClient*> all;
    for (TestClient& client : clients) all.push_back(&client);
    return serveUntil(context, all, done);
  }
  HttpClient::Reply get(const std::string& path) const {
    return HttpClient::get(server->metricsPort(), path);
  }
  double value(const std::string& sample) const { return metricOf(get("/metrics").body, sample); }
  /// Waits until a page shows a value that satisfies `wanted`. A new value may take a second to appear.
  bool reaches(const std::string& sample, const std::function<bool(double)>& wanted) {
    return serve([&] { return wanted(value(sample)); });
  }
  static std::function<bool(double)> is(double wanted) {
    return [wanted](double value) { return value == wanted; };
  }
  static std::function<bool(double)> isOver(double least) {
    return [least](double value) { return value > least; };
  }

  std::atomic<bool> blocks = false;
  std::unique_ptr<TestServer> server;
  std::list<TestClient> clients;
};

TEST_F(Metrics, ValuesFollowTheGame) {
  start(busyWorld(50));
  ASSERT_TRUE(reaches("naiad_ticks_total", isOver(0)));
  EXPECT_EQ(value(R"(naiad_players{state="connected"})"), 0);
  EXPECT_EQ(value("naiad_tick_length_seconds"), 0.003);

  TestClient& ann = join("ann");
  EXPECT_TRUE(reaches(R"(naiad_players{state="connected"})", is(1)));
  EXPECT_EQ(value("naiad_joins_total"), 1);
  EXPECT_EQ(value("naiad_rooms"), 1);
  EXPECT_GT(value("naiad_objects"), 10);
  EXPECT_TRUE(reaches(R"(naiad_snapshots_total{path="stream"})", isOver(100)));
  EXPECT_GT(value(R"(naiad_snapshot_bytes_total{path="stream"})"), 100);
  EXPECT_GT(value("naiad_tick_duration_seconds_count"), 100);
  EXPECT_GT(value("naiad_tick_lateness_seconds_count"), 100);
  EXPECT_GT(value("naiad_tick_duration_seconds_sum"), 0);
  for (const char* stage : {"idle", "receive", "inputs", "world", "publish", "snapshots", "flush"})
    EXPECT_GT(value("naiad_stage_seconds_total{" + std::string("stage=\"") + stage + "\"}"), 0) << stage;
  EXPECT_TRUE(reaches(R"(naiad_network_bytes_total{direction="out",transport="tcp"})", isOver(1000)));
  EXPECT_GT(value(R"(naiad_network_frames_total{direction="in"})"), 0);
  EXPECT_TRUE(reaches("naiad_round_trip_seconds_count", isOver(0)));
  EXPECT_GT(value(R"(naiad_thread_cpu_seconds_total{thread="tick"})"), 0);
  EXPECT_GT(value(R"(naiad_thread_cpu_seconds_total{thread="network"})"), 0);
  EXPECT_GT(value(R"(naiad_thread_cpu_seconds_total{thread="metrics"})"), 0);

  ann.session().sendKey(df::Keyboard::LEFTARROW, df::KEY_PRESSED, Clock::now());
  EXPECT_TRUE(reaches("naiad_inputs_total", isOver(0)));
  ann.connection().leave();
  EXPECT_TRUE(reaches(R"(naiad_leaves_total{reason="voluntary"})", is(1)));
  EXPECT_TRUE(reaches(R"(naiad_players{state="connected"})", is(0)));
  EXPECT_TRUE(reaches("naiad_objects", is(0))) << "nobody watches";
}

TEST_F(Metrics, PageOfAFullServerHidesNames) {
  HostOptions options = withMetrics();
  options.max_players = 1;
  start(busyWorld(5), options);
  EXPECT_TRUE(serve([&] { return get("/readyz").status == 200; }));
  join("zebedee");
  EXPECT_TRUE(serve([&] { return get("/readyz").status == 503; }));
  EXPECT_EQ(get("/readyz").body, "full\n");
  EXPECT_EQ(get("/healthz").status, 200);
  ASSERT_TRUE(reaches(R"(naiad_players{state="connected"})", is(1)));
  EXPECT_FALSE(has(get("/metrics").body, "zebedee")) << "no player's name is on the page";
  clients.clear();
  EXPECT_TRUE(reaches(R"(naiad_leaves_total{reason="disconnected"})", is(1)));
  EXPECT_TRUE(serve([&] { return get("/readyz").status == 200; }));
}

/// Blocks the tick while `blocks` is set.
class Blocker : public df::Object {
 public:
  explicit Blocker(const std::atomic<bool>& blocks) : m_blocks(blocks) { registerInterest(df::STEP_EVENT); }
  int eventHandler(const df::Event* /*p_e*/) override {
    while (m_blocks) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return 1;
  }

 private:
  const std::atomic<bool>& m_blocks;
};

TEST_F(Metrics, HungGameIsUnhealthyUntilItRecovers) {
  start([this](df::World&) { new Blocker(blocks); });
  EXPECT_TRUE(serve([&] { return get("/readyz").status == 200; }));
  blocks = true;
  EXPECT_TRUE(serve([&] { return get("/healthz").status == 503; }));
  const HttpClient::Reply reply = get("/healthz");
  EXPECT_TRUE(reply.body.ends_with("stage world\n")) << reply.body;
  EXPECT_EQ(get("/readyz").status, 503);
  EXPECT_EQ(get("/metrics").status, 200) << "metrics come from a thread of their own";
  blocks = false;
  EXPECT_TRUE(serve([&] { return get("/healthz").status == 200 && get("/readyz").status == 200; }));
}

// ---- audit of pictures ------------------------------------------------------------------------------------

TEST_F(Metrics, AuditFindsNoWrongCellsWithDatagramLoss) {
  HostOptions options = home.server();
  options.metrics = "127.0.0.1:0";
  start(busyWorld(100), options);
  clients.emplace_back(context, server->port(), playerWithValve("ann"));
  clients.back().keepPictures(false);
  TestClient& ann = clients.back();
  ASSERT_TRUE(serve([&] { return isOnDatagrams(ann); }));
  // Only one second in ten is audited, so this may take ten seconds.
  SplitMix64 random(5);
  const double pictures = value("naiad_audit_pictures_total");
  const double datagrams = value(R"(naiad_snapshots_total{path="datagram"})");
  EXPECT_TRUE(serve([&] {
    valve->down = random.below(10) != 0;
    valve->up = random.below(20) != 0;
    return value("naiad_audit_pictures_total") >= pictures + 20 &&
           value(R"(naiad_snapshots_total{path="datagram"})") > datagrams + 100;
  }));
  EXPECT_EQ(value("naiad_audit_cells_total"), value("naiad_audit_pictures_total") * 80 * 24);
  EXPECT_EQ(value("naiad_audit_wrong_cells_total"), 0);
}

}  // namespace
}  // namespace naiad::test
