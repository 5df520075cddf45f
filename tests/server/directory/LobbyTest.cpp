// The lobby of a directory and servers that are full: the real programs, the real nats-server, clients as
// dfclient has them.
#include <gtest/gtest.h>
#include <signal.h>
#include <stdlib.h>

#include <asio/io_context.hpp>
#include <chrono>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "host/fleet/Bus.h"
#include "shared/net/stream/JoinLink.h"
#include "tests/loopback/GameProgram.h"
#include "tests/loopback/Home.h"
#include "tests/loopback/RawClient.h"
#include "tests/loopback/TestClient.h"
#include "tests/server/host/fleet/NatsServer.h"
#include "tests/support/RunningProgram.h"

namespace naiad::test {
namespace {

using namespace std::chrono_literals;

class LobbyTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!busComplaint({"nats://127.0.0.1:1", "", ""}).empty()) GTEST_SKIP() << "built without libnats";
    if (!NatsServer::isInstalled()) GTEST_SKIP() << "nats-server is not installed";
    ASSERT_TRUE(bus.start()) << bus.log();
  }
  std::unique_ptr<GameProgram> startServer(const std::string& id, int places,
                                           const std::string& game = "hello") {
    return std::make_unique<GameProgram>(
        "dfserver", std::map<std::string, std::string>{{"NAIAD_GAME", game},
                                                       {"NAIAD_BUS", bus.url()},
                                                       {"NAIAD_BUS_ID", id},
                                                       {"NAIAD_MAX_PLAYERS", std::to_string(places)},
                                                       {"NAIAD_LINK_HOST", "127.0.0.1"}});
  }
  /// dfdir with a lobby, once it knows so many servers.
  void startDirectory(int servers) {
    directory = std::make_unique<RunningProgram>(std::vector<std::string>{
        "dfdir", "--bus", bus.url(), "--listen", "127.0.0.1:0", "--identity", home.identity("directory")});
    ASSERT_TRUE(directory->prints(" is there", servers)) << directory->printed();
    const std::string& text = directory->printed();
    const std::size_t begin = text.find("naiad://");
    const auto link = JoinLink::parse(text.substr(begin, text.find('\'', begin) - begin));
    ASSERT_TRUE(std::holds_alternative<JoinLink>(link)) << text;
    lobby = std::get<JoinLink>(link).where.port;
  }
  std::unique_ptr<TestClient> join(std::uint16_t port, const std::string& name,
                                   const std::string& game = "") {
    ClientSetup setup = home.player(name);
    setup.options.game = game;
    auto client = std::make_unique<TestClient>(context, port, setup);
    client->keepPictures(false);
    EXPECT_TRUE(serve({client.get()}, [&] { return client->joined() || client->connection().isOver(); }));
    return client;
  }
  bool serve(std::initializer_list<TestClient*> clients, const std::function<bool()>& done) {
    return serveUntil(context, clients, done);
  }

  Home home;
  asio::io_context context;
  NatsServer bus;
  std::unique_ptr<RunningProgram> directory;
  std::uint16_t lobby = 0;
};

TEST_F(LobbyTest, PlayersAreSentToAServerOfTheirGame) {
  const auto hello = startServer("hello-1", 8);
  const auto maze = startServer("maze-1", 8, "maze");
  ASSERT_NO_FATAL_FAILURE(startDirectory(2));
  const auto ann = join(lobby, "ann", "maze");
  const auto bob = join(lobby, "bob", "hello");
  ASSERT_TRUE(ann->joined() && bob->joined()) << ann->connection().sentence() << bob->connection().sentence();
  EXPECT_EQ(ann->session().welcome().game, "maze");
  EXPECT_EQ(bob->session().welcome().game, "hello");
  EXPECT_EQ(ann->connection().address().port, maze->port());
  const auto eve = join(lobby, "eve", "chess");
  EXPECT_NE(eve->connection().sentence().find("chess"), std::string::npos) << eve->connection().sentence();
  directory->signal(SIGTERM);
  EXPECT_EQ(directory->finish(), 0);
  EXPECT_NE(directory->printed().find(" hellos=3 sent_on=2 no_game=1"), std::string::npos)
      << directory->printed();
}

TEST_F(LobbyTest, AServerThatIsFullSendsOnToOneThatIsNot) {
  const auto small = startServer("small", 1);
  const auto large = startServer("large", 8);
  ASSERT_NO_FATAL_FAILURE(startDirectory(2));
  const auto ann = join(small->port(), "ann");
  ASSERT_TRUE(ann->joined());
  // Until the directory has heard that it is full, and it has heard the directory.
  std::unique_ptr<TestClient> bob;
  for (int tries = 0; tries < 200; ++tries) {
    bob = join(small->port(), "bob");
    if (bob->joined()) break;
    serve({ann.get()}, [end = std::chrono::steady_clock::now() + 100ms] {
      return std::chrono::steady_clock::now() > end;
    });
  }
  ASSERT_TRUE(bob->joined()) << bob->connection().sentence();
  EXPECT_EQ(bob->connection().address().port, large->port());
  EXPECT_EQ(ann->connection().address().port, small->port());
}

TEST_F(LobbyTest, WithoutABusItSendsPlayersOnAsBefore) {
  const auto server = startServer("berlin", 8);
  ASSERT_NO_FATAL_FAILURE(startDirectory(1));
  bus.kill();
  ASSERT_TRUE(directory->prints("the bus cannot be reached"));
  const auto ann = join(lobby, "ann");
  EXPECT_TRUE(ann->joined()) << ann->connection().sentence();
}

TEST_F(LobbyTest, StrangersWhoSayNothingOrNonsenseCostItNothing) {
  const auto server = startServer("berlin", 8);
  ASSERT_NO_FATAL_FAILURE(startDirectory(1));
  RawClient silent(lobby, RawClient::Line::kTls);
  RawClient garbage(lobby, RawClient::Line::kTls);
  garbage.sendFrame("no hello");
  EXPECT_TRUE(garbage.waitForHangup());
  RawClient longer(lobby, RawClient::Line::kTls);
  longer.sendFrame(std::string(5'000, 'x'));
  EXPECT_TRUE(longer.waitForHangup());
  RawClient twice(lobby, RawClient::Line::kTls);
  twice.send(RawClient::hello("ann"));
  twice.send(RawClient::hello("ann"));
  ASSERT_TRUE(twice.receive());
  EXPECT_TRUE(twice.waitForHangup()) << "one answer";
  EXPECT_TRUE(silent.waitForHangup()) << "five seconds";
  EXPECT_TRUE(join(lobby, "ann")->joined());
  directory->signal(SIGTERM);
  EXPECT_EQ(directory->finish(), 0);
  for (const char* count : {" hellos=2", " malformed=1", " late=1"})
    EXPECT_NE(directory->printed().find(count), std::string::npos) << count << directory->printed();
}

}  // namespace
}  // namespace naiad::test
