// A session outlives its stream and its client's process: another stream or another process resumes it. The
// game does not notice, and the player keeps their ship.
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "Compare.h"
#include "LoopbackFixture.h"
#include "RecordingServer.h"
#include "StreamProxy.h"
#include "engine/world/ObjectRegistry.h"
#include "engine/world/Player.h"
#include "engine/world/Views.h"

namespace naiad::test {
namespace {

/// A busy server. Its clients' streams pass through a proxy; their datagrams do not.
class ProxiedServer : public LoopbackFixture {
 protected:
  void start(HostOptions options) {
    server = std::make_unique<TestServer>(busyWorld(50, &census), std::move(options));
    proxy = std::make_unique<StreamProxy>(context, server->port());
    valve->server_port = server->port();
  }
  void start() { start(home.server()); }
  virtual ClientSetup player(const std::string& name) { return playerWithValve(name); }
  /// Waits until a picture after this call equals the server's.
  bool seesTheTruth(TestClient& client) {
    client.forgetPictures();
    return serve(client, [&] { return showsTheTruth(client, *server); });
  }
  void expectNoJoinOrLeave() {
    EXPECT_EQ(census.joins, 1);
    EXPECT_EQ(census.leaves, 0);
    EXPECT_EQ(server->counters().joined, 1u);
  }

  Census census;
  std::unique_ptr<TestServer> server;
  std::unique_ptr<StreamProxy> proxy;
};

// ---- another stream ---------------------------------------------------------------------------------------

class Resume : public ProxiedServer {
 protected:
  bool settle(TestClient& client) {
    return serve(client, [&] { return isOnDatagrams(client) && client.session().score() >= 0; });
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
    return serve(client, [&] {
      return client.joined() && !client.session().isDetached() && server->counters().resumed >= times;
    });
  }
  /// Breaks the stream and lets the proxy refuse new ones. True if the client notices the loss.
  bool losesItsStream(TestClient& client) {
    proxy->setOpen(false);
    proxy->cut();
    return serve(client, [&] { return client.session().isDetached(); });
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
  ASSERT_TRUE(serve(ann, [&] { return ann.joined(); }));
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
  EXPECT_TRUE(serve(ann, [&] { return ann.newestTick() > tick + 400; }));
  EXPECT_TRUE(ann.session().isDetached());
  const auto keys = [&] {
    return server->inWorld([&](df::World& world) { return world.views().player(ann.player())->getScore(); });
  };
  const int before = keys();
  ann.session().sendKey(df::Keyboard::RIGHTARROW, df::KEY_PRESSED, Clock::now());
  EXPECT_TRUE(serve(ann, [&] { return keys() > before; }));
  EXPECT_EQ(server->counters().detached, 1u);

  proxy->setOpen(true);
  ASSERT_TRUE(resumes(ann, 1));
  EXPECT_TRUE(keyWorks(ann));
  expectNoJoinOrLeave();
}

TEST_F(Resume, TheRoundTripIsMeasuredWithoutAStream) {
  TestClient& ann = startAndSettle();
  ASSERT_TRUE(losesItsStream(ann));
  EXPECT_TRUE(
      serve(ann, [&] { return ann.session().inputTickEstimator().shortestRoundTrip().count() < 40; }));
  const auto before = ann.session().roundTrip();
  valve->delay = before + std::chrono::milliseconds(100);
  const auto longer = before + std::chrono::milliseconds(40);
  EXPECT_TRUE(serve(ann, [&] { return ann.session().roundTrip() >= longer; })) << "as datagrams go";
  EXPECT_TRUE(ann.session().isDetached());
}

TEST_F(Resume, ImpostorServerReceivesNoBytesOnReconnect) {
  TestClient& ann = startAndSettle("xyzzy");
  RecordingServer impostor(home.identity("another identity"));
  proxy->setServer(impostor.port());
  proxy->cut();  // datagrams still reach the real server
  ASSERT_TRUE(serve(ann, [&] { return impostor.isDecided(1); }));
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
  ASSERT_TRUE(serve(ann, [&] { return ann.joined(); }));
  proxy->setServer(impostor.port());
  ASSERT_TRUE(serve(ann, [&] { return impostor.isDecided(1); }));
  EXPECT_EQ(impostor.heard(), "");
  EXPECT_TRUE(ann.joined()) << "the first stream goes on";
  EXPECT_FALSE(ann.session().hasSecondStream());
  EXPECT_TRUE(keyWorks(ann));
}

TEST_F(Resume, TemporarilyRefusedClientReconnectsByItself) {
  TestClient& ann = startAndSettle();
  const std::uint32_t id = ann.player();
  // Break each new stream at once, until the server asks the client, because of many resumes, to wait.
  ASSERT_TRUE(serve(ann, [&] {
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

// ---- another process --------------------------------------------------------------------------------------

class Return : public ProxiedServer {
 protected:
  ClientSetup player(const std::string& name) override {
    ClientSetup setup = ProxiedServer::player(name);
    setup.sessions = home.sessions();
    return setup;
  }
  std::unique_ptr<TestClient> client(const ClientSetup& setup) {
    return std::make_unique<TestClient>(context, proxy->port(), setup);
  }
  std::unique_ptr<TestClient> client(const std::string& name) { return client(player(name)); }
  std::unique_ptr<TestClient> startAndSettle() {
    start();
    auto ann = client("ann");
    EXPECT_TRUE(settles(*ann));
    return ann;
  }
  /// Destroys the client as if its process was killed, and joins with another one.
  testing::AssertionResult comesBack(std::unique_ptr<TestClient>& ann) {
    ann.reset();
    ann = client("ann");
    return joins(*ann);
  }
  bool scores(TestClient& client, std::int32_t score) {
    return serve(client, [&] { return client.session().score() == score; });
  }
  /// Presses a key this many times, waiting for each. The score counts the presses.
  bool press(TestClient& client, int times) {
    const std::int32_t from = client.session().score();
    for (int i = 1; i <= times; ++i) {
      client.session().sendKey(df::Keyboard::RIGHTARROW, df::KEY_PRESSED, Clock::now());
      if (!scores(client, from + i)) return false;
    }
    return true;
  }
  /// Plays for 300 ticks. True if the pictures and the checksums are right.
  bool playsOn(TestClient& client) {
    return hears(client, 300) && seesTheTruth(client) && server->counters().divergences == 0;
  }
  static std::vector<std::string> linesOf(TestClient& client) {
    std::vector<std::string> lines;
    for (const ChatEntry& entry : client.session().chat()) lines.push_back(entry.text);
    return lines;
  }
};

TEST_F(Return, RestartedClientGetsItsObjectBack) {
  auto ann = startAndSettle();
  ASSERT_TRUE(press(*ann, 3));
  const std::uint32_t id = ann->player();
  for (std::uint64_t round = 1; round <= 3; ++round) {
    const auto score = static_cast<std::int32_t>(1 + 2 * round);
    ASSERT_TRUE(comesBack(ann));
    EXPECT_EQ(ann->player(), id);
    EXPECT_EQ(ann->session().welcome().name, "ann");
    EXPECT_EQ(linesOf(*ann), std::vector<std::string>{"Session resumed."});
    EXPECT_TRUE(scores(*ann, score)) << "the player list came";
    EXPECT_TRUE(press(*ann, 1)) << "its keys are no repetitions";
    EXPECT_TRUE(settles(*ann));
    EXPECT_TRUE(playsOn(*ann));
    proxy->cut();
    ASSERT_TRUE(serve(*ann, [&] {
      return !ann->session().isDetached() && server->counters().resumed == 2 * round;
    })) << "the new client's stream is replaced";
    EXPECT_TRUE(press(*ann, 1));
    EXPECT_EQ(server->counters().restarted, round);
  }
  EXPECT_TRUE(playsOn(*ann));
  EXPECT_EQ(census.pressed, 9);
  EXPECT_EQ(ann->session().counters().resets, 0u);
  EXPECT_EQ(
      server->inWorld([](df::World& world) { return world.objects().objectsOfType("Ship").getCount(); }), 1);
  expectNoJoinOrLeave();
}

TEST_F(Return, SessionIsResumedWithoutDatagrams) {
  start();
  valve->up = valve->down = false;
  auto ann = client("ann");
  ASSERT_TRUE(joins(*ann));
  ASSERT_TRUE(scores(*ann, 0) && press(*ann, 2));
  ASSERT_TRUE(comesBack(ann));
  EXPECT_TRUE(scores(*ann, 2) && press(*ann, 1));
  EXPECT_TRUE(playsOn(*ann));
  expectNoJoinOrLeave();
}

TEST_F(Return, KeysOfAKilledClientAreReleased) {
  auto ann = startAndSettle();
  for (const auto key : {df::Keyboard::LEFTARROW, df::Keyboard::SPACE, df::Keyboard::A}) {
    ann->session().sendKey(key, df::KEY_PRESSED, Clock::now());
  }
  ann->session().sendKey(df::Keyboard::SPACE, df::KEY_RELEASED, Clock::now());
  ASSERT_TRUE(serve(*ann, [&] { return census.pressed == 3 && census.released == 1; }));
  ann.reset();
  ASSERT_TRUE(serveUntil(context, {}, [&] { return census.released == 3; }));

  ann = client("ann");
  ASSERT_TRUE(joins(*ann));
  ann->session().sendKey(df::Keyboard::B, df::KEY_PRESSED, Clock::now());
  ASSERT_TRUE(serve(*ann, [&] { return census.pressed == 4; }));
  EXPECT_TRUE(playsOn(*ann));
  EXPECT_EQ(census.released, 3)
      << "each key is released once, and a client that is back keeps its own pressed";
  proxy->stall();
  ASSERT_TRUE(comesBack(ann));
  EXPECT_TRUE(serve(*ann, [&] { return census.released == 4; })) << "also where the server did not know";
}

TEST_F(Return, SessionMovesToTheClientWithTheToken) {
  auto ann = startAndSettle();
  ASSERT_TRUE(press(*ann, 2));
  ClientSetup copy = player("copy");
  copy.sessions.clear();
  copy.options.resume_token = ann->session().welcome().resume_token;
  copy.options.new_process = true;
  auto elsewhere = client(copy);
  ASSERT_TRUE(serveUntil(context, {ann.get(), elsewhere.get()},
                         [&] { return elsewhere->joined() && ann->connection().isOver(); }));
  EXPECT_EQ(ann->connection().state(), Connection::State::kEnded);
  EXPECT_EQ(ann->connection().message(), "This session was resumed in another client.");
  EXPECT_TRUE(scores(*elsewhere, 2) && press(*elsewhere, 1));
  EXPECT_TRUE(playsOn(*elsewhere));
  expectNoJoinOrLeave();
  // The first client has deleted its void session file.
  EXPECT_TRUE(std::filesystem::exists(home.sessions()));
  for (const auto& entry : std::filesystem::directory_iterator(home.sessions())) {
    EXPECT_EQ(entry.path().filename(), "lock");
  }
}

TEST_F(Return, AnotherServerDoesNotGetToSeeTheToken) {
  auto ann = startAndSettle();
  ann.reset();
  TestServer impostor(busyWorld(1, &census), home.server("another key"));
  proxy->setServer(impostor.port());
  valve->server_port = impostor.port();
  ClientSetup trusting = player("ann");
  trusting.trust.fingerprint = impostor.fingerprint();
  ann = client(trusting);
  ASSERT_TRUE(joins(*ann));
  EXPECT_EQ(impostor.counters().unknown_tokens, 0u);
}

TEST_F(Return, AfterTheGraceTimeClientIsANewPlayer) {
  HostOptions options = home.server();
  options.grace = 0.3;
  start(options);
  auto ann = client("ann");
  ASSERT_TRUE(settles(*ann));
  EXPECT_EQ(ann->session().welcome().grace, std::chrono::milliseconds(300));
  ann.reset();
  const auto killed = Clock::now();
  ASSERT_TRUE(serveUntil(context, {}, [&] { return census.leaves == 1; }));
  EXPECT_GT(Clock::now() - killed, std::chrono::milliseconds(200));
  EXPECT_EQ(server->counters().detached, 1u);
  EXPECT_EQ(server->counters().reconnect_timeouts, 1u);
  EXPECT_EQ(
      server->inWorld([](df::World& world) { return world.objects().objectsOfType("Ship").getCount(); }), 0);
  ann = client("ann");
  ASSERT_TRUE(joins(*ann));
  EXPECT_EQ(census.joins, 2);
  EXPECT_EQ(server->counters().restarted, 0u);
  EXPECT_TRUE(linesOf(*ann).empty());
}

TEST_F(Return, ChatDuringADisconnectArrivesOnceInOrder) {
  auto ann = startAndSettle();
  TestClient bob(context, server->port(), home.player("bob"));
  ASSERT_TRUE(serveUntil(context, {ann.get(), &bob}, [&] { return bob.joined() && lists(*ann, "bob"); }));
  ann->session().sendChat("before");
  bob.session().sendChat("also before");
  const auto both = [&](std::size_t lines) {
    return serveUntil(context, {ann.get(), &bob},
                      [&] { return linesOf(*ann).size() >= lines && linesOf(bob).size() >= lines; });
  };
  ASSERT_TRUE(both(2));
  for (int round = 0; round < 3; ++round) {
    const std::size_t had = linesOf(bob).size();
    const std::string number = std::to_string(round);
    proxy->setOpen(false);
    round == 1 ? proxy->stall() : proxy->cut();  // chat is lost with a stream, or has none
    ann->session().sendChat("one " + number);
    bob.session().sendChat("hello? " + number);
    ann->session().sendChat("two " + number);
    ASSERT_TRUE(serveUntil(context, {ann.get(), &bob}, [&] { return linesOf(bob).size() == had + 1; }));
    proxy->setOpen(true);
    ASSERT_TRUE(both(had + 3));
    ASSERT_TRUE(serveUntil(context, {ann.get(), &bob}, [&] { return !ann->session().isDetached(); }));
    const auto heard = linesOf(bob);
    EXPECT_EQ(heard[had], "hello? " + number);
    EXPECT_EQ(heard[had + 1], "one " + number);
    EXPECT_EQ(heard[had + 2], "two " + number);
    EXPECT_EQ(linesOf(*ann), heard) << "the same in the same order, each once";
  }
  EXPECT_EQ(server->counters().chat_dropped, 0u);
  EXPECT_EQ(server->counters().outbox_sounds_dropped, 0u);
}

}  // namespace
}  // namespace naiad::test
