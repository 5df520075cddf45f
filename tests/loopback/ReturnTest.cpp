// A client is killed and another process resumes its session. The game does not notice.
#include <gtest/gtest.h>

#include "ProxiedServer.h"
#include "engine/world/ObjectRegistry.h"
#include "engine/world/Player.h"

namespace naiad::test {
namespace {

using Clock = std::chrono::steady_clock;

constexpr const char* kElsewhere = "This session was resumed in another client.";

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
    return serveUntil(context, {&client}, [&] { return client.session().score() == score; });
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
    ASSERT_TRUE(serveUntil(context, {ann.get()}, [&] {
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
  ASSERT_TRUE(serveUntil(context, {ann.get()}, [&] { return census.pressed == 3 && census.released == 1; }));
  ann.reset();
  ASSERT_TRUE(serveUntil(context, {}, [&] { return census.released == 3; }));

  ann = client("ann");
  ASSERT_TRUE(joins(*ann));
  ann->session().sendKey(df::Keyboard::B, df::KEY_PRESSED, Clock::now());
  ASSERT_TRUE(serveUntil(context, {ann.get()}, [&] { return census.pressed == 4; }));
  EXPECT_TRUE(playsOn(*ann));
  EXPECT_EQ(census.released, 3)
      << "each key is released once, and a client that is back keeps its own pressed";
  proxy->stall();
  ASSERT_TRUE(comesBack(ann));
  EXPECT_TRUE(serveUntil(context, {ann.get()}, [&] { return census.released == 4; }))
      << "also where the server did not know";
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
  EXPECT_EQ(ann->connection().message(), kElsewhere);
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
