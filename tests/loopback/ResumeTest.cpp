// A session outlives its stream: the game does not notice, and the player keeps their ship.
#include <gtest/gtest.h>

#include "ProxiedServer.h"
#include "RecordingServer.h"
#include "engine/world/Player.h"
#include "engine/world/Views.h"

namespace naiad::test {
namespace {

using Clock = std::chrono::steady_clock;

class Resume : public ProxiedServer {
 protected:
  bool settle(TestClient& client) {
    return serveUntil(context, {&client},
                      [&] { return isOnDatagrams(client) && client.session().score() >= 0; });
  }
  TestClient& startAndSettle(const std::string& password = "") {
    start();
    ClientSetup setup = player("ann");
    setup.options.password = password;
    settled = std::make_unique<TestClient>(context, proxy->port(), setup);
    EXPECT_TRUE(settle(*settled));
    return *settled;
  }
  bool resumes(TestClient& client, std::uint64_t times) {
    return serveUntil(context, {&client}, [&] {
      return client.joined() && !client.session().isDetached() && server->counters().resumed >= times;
    });
  }
  /// Breaks the stream and lets the proxy refuse new ones. True if the client notices the loss.
  bool losesItsStream(TestClient& client) {
    proxy->setOpen(false);
    proxy->cut();
    return serveUntil(context, {&client}, [&] { return client.session().isDetached(); });
  }

  std::unique_ptr<TestClient> settled;
};

TEST_F(Resume, ABrokenStreamIsReplacedUnnoticed) {
  TestClient& ann = startAndSettle();
  const std::uint32_t id = ann.player();
  for (std::uint64_t round = 1; round <= 3; ++round) {
    const ClientSession* session = &ann.session();
    const std::string token = ann.session().welcome().resume_token;
    proxy->cut();
    ASSERT_TRUE(resumes(ann, round));
    EXPECT_EQ(&ann.session(), session) << "the same session goes on";
    EXPECT_EQ(ann.player(), id);
    EXPECT_NE(ann.session().welcome().resume_token, token);
    EXPECT_EQ(ann.connection().state(), Connection::State::kJoined);
    EXPECT_TRUE(keyWorks(ann));
    EXPECT_TRUE(settle(ann));
    EXPECT_TRUE(seesTheTruth(ann));
  }
  const Counters counters = server->counters();
  EXPECT_EQ(counters.resumed, 3u);
  EXPECT_LE(counters.detached, 3u);
  EXPECT_EQ(counters.divergences, 0u);
  EXPECT_EQ(ann.session().counters().resets, 0u);
  expectNoJoinOrLeave();
  EXPECT_EQ(proxy->count(), 4);
}

TEST_F(Resume, ClientResumesAfterItsSessionTimedOut) {
  TestClient& ann = startAndSettle();
  const std::uint32_t id = ann.player();
  ASSERT_TRUE(losesItsStream(ann));
  valve->down = valve->up = false;
  const Clock::time_point later = Clock::now() + ClientSession::kDetachedTimeout + std::chrono::seconds(10);
  for (Clock::time_point now = Clock::now(); now < later; now += std::chrono::milliseconds(100))
    ann.connection().update(now);
  EXPECT_EQ(ann.session().state(), ClientSession::State::kLost);
  valve->down = valve->up = true;
  proxy->setOpen(true);
  ASSERT_TRUE(serveUntil(context, {&ann}, [&] { return ann.joined(); }));
  EXPECT_EQ(ann.player(), id);
  EXPECT_TRUE(settle(ann));
  EXPECT_TRUE(keyWorks(ann));
  expectNoJoinOrLeave();
}

TEST_F(Resume, DatagramsContinueWithoutAStream) {
  TestClient& ann = startAndSettle();
  ASSERT_TRUE(losesItsStream(ann));
  // Two seconds of play, with keys.
  const std::uint32_t tick = ann.newestTick();
  EXPECT_TRUE(serveUntil(context, {&ann}, [&] { return ann.newestTick() > tick + 400; }));
  EXPECT_TRUE(ann.session().isDetached());
  const auto keys = [&] {
    return server->inWorld([&](df::World& world) { return world.views().player(ann.player())->getScore(); });
  };
  const int before = keys();
  ann.session().sendKey(df::Keyboard::RIGHTARROW, df::KEY_PRESSED, Clock::now());
  EXPECT_TRUE(serveUntil(context, {&ann}, [&] { return keys() > before; }));
  EXPECT_EQ(server->counters().detached, 1u);

  proxy->setOpen(true);
  ASSERT_TRUE(resumes(ann, 1));
  EXPECT_TRUE(keyWorks(ann));
  expectNoJoinOrLeave();
}

TEST_F(Resume, TheRoundTripIsMeasuredWithoutAStream) {
  TestClient& ann = startAndSettle();
  ASSERT_TRUE(losesItsStream(ann));
  EXPECT_TRUE(serveUntil(
      context, {&ann}, [&] { return ann.session().inputTickEstimator().shortestRoundTrip().count() < 40; }));
  const auto before = ann.session().roundTrip();
  valve->delay = before + std::chrono::milliseconds(100);
  const auto longer = before + std::chrono::milliseconds(40);
  EXPECT_TRUE(serveUntil(context, {&ann}, [&] { return ann.session().roundTrip() >= longer; }))
      << "as datagrams go";
  EXPECT_TRUE(ann.session().isDetached());
}

TEST_F(Resume, ImpostorServerReceivesNoBytesOnReconnect) {
  TestClient& ann = startAndSettle("xyzzy");
  RecordingServer impostor(home.identity("another identity"));
  proxy->setServer(impostor.port());
  proxy->cut();  // datagrams still reach the real server
  ASSERT_TRUE(serveUntil(context, {&ann}, [&] { return impostor.isDecided(1); }));
  EXPECT_EQ(impostor.heard(), "");
  ASSERT_TRUE(ends(ann));
  EXPECT_EQ(ann.connection().state(), Connection::State::kRefused);
  EXPECT_EQ(server->counters().resumed, 0u);
}

TEST_F(Resume, ImpostorOnTheSecondStreamReceivesNoBytes) {
  start();
  RecordingServer impostor(home.identity("another identity"));
  valve->up = valve->down = false;
  ClientSetup setup = player("ann");
  setup.options.password = "xyzzy";
  TestClient ann(context, proxy->port(), setup);
  ASSERT_TRUE(serveUntil(context, {&ann}, [&] { return ann.joined(); }));
  proxy->setServer(impostor.port());
  ASSERT_TRUE(serveUntil(context, {&ann}, [&] { return impostor.isDecided(1); }));
  EXPECT_EQ(impostor.heard(), "");
  EXPECT_TRUE(ann.joined()) << "the first stream goes on";
  EXPECT_FALSE(ann.session().hasSecondStream());
  EXPECT_TRUE(keyWorks(ann));
}

TEST_F(Resume, TemporarilyRefusedClientReconnectsByItself) {
  TestClient& ann = startAndSettle();
  const std::uint32_t id = ann.player();
  // Break each new stream at once, until the server asks the client, because of many resumes, to wait.
  ASSERT_TRUE(serveUntil(context, {&ann}, [&] {
    if (ann.joined() && !ann.session().isDetached()) proxy->cut();
    return ann.connection().isDeferred();
  }));
  EXPECT_EQ(ann.connection().state(), Connection::State::kReconnecting);
  EXPECT_TRUE(has(ann.connection().message(), "Too many reconnects"));
  const std::uint64_t resumed = server->counters().resumed;
  EXPECT_GE(resumed, 3u);
  ASSERT_TRUE(resumes(ann, resumed + 1));
  EXPECT_FALSE(ann.connection().isDeferred());
  EXPECT_EQ(ann.player(), id);
  EXPECT_TRUE(keyWorks(ann));
  EXPECT_GE(server->counters().resumes_deferred, 1u);
  expectNoJoinOrLeave();
}

}  // namespace
}  // namespace naiad::test
