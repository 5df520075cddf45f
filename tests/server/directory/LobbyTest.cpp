// A directory's lobby and full servers: the real programs, the real nats-server, and clients like dfclient's.
// The lobby's answers to hellos and to other frames.
#include <gtest/gtest.h>
#include <signal.h>

#include <asio/io_context.hpp>
#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "BusFixture.h"
#include "SamplePresence.h"
#include "host/auth/ServerIdentity.h"
#include "server/directory/Lobby.h"
#include "shared/net/base/Limits.h"
#include "shared/net/stream/JoinLink.h"
#include "shared/values/SplitMix64.h"
#include "tests/loopback/BusyWorld.h"
#include "tests/loopback/GameProgram.h"
#include "tests/loopback/Home.h"
#include "tests/loopback/RawClient.h"
#include "tests/loopback/TestClient.h"
#include "tests/loopback/TestServer.h"
#include "tests/support/RunningProgram.h"

namespace naiad::test {
namespace {

using namespace std::chrono_literals;

class LobbyTest : public BusFixture {
 protected:
  void SetUp() override {
    BusFixture::SetUp();
    if (IsSkipped()) return;
    ASSERT_TRUE(bus.start()) << bus.log();
  }
  std::unique_ptr<GameProgram> startServer(const std::string& id, int places,
                                           const std::string& game = "hello") {
    auto environment = serverOf(bus, id, game);
    environment["NAIAD_MAX_PLAYERS"] = std::to_string(places);
    return std::make_unique<GameProgram>("dfserver", environment);
  }
  /// Starts dfdir with a lobby and waits until it knows this many servers.
  void startDirectory(int servers) {
    directory = std::make_unique<RunningProgram>(
        std::vector<std::string>{"dfdir", "--bus", bus.url(), "--bus-interval", kQuickInterval, "--listen",
                                 "127.0.0.1:0", "--identity", home.identity("directory")});
    ASSERT_TRUE(directory->prints(" joined the fleet", servers)) << directory->printed();
    const std::string& text = directory->printed();
    const std::size_t begin = text.find("naiad://");
    const auto link = JoinLink::parse(text.substr(begin, text.find('\'', begin) - begin));
    ASSERT_TRUE(std::holds_alternative<JoinLink>(link)) << text;
    lobby = std::get<JoinLink>(link).address.port;
  }
  std::unique_ptr<TestClient> join(std::uint16_t port, const std::string& name, const std::string& game = "",
                                   const std::string& room = "") {
    ClientSetup setup = home.player(name);
    setup.options.game = game;
    setup.options.room = room;
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
  ASSERT_TRUE(ann->joined() && bob->joined()) << ann->connection().message() << bob->connection().message();
  EXPECT_EQ(ann->session().welcome().game, "maze");
  EXPECT_EQ(bob->session().welcome().game, "hello");
  EXPECT_EQ(ann->connection().address().port, maze->port());
  const auto eve = join(lobby, "eve", "chess");
  EXPECT_TRUE(has(eve->connection().message(), "chess"));
  directory->signal(SIGTERM);
  EXPECT_EQ(directory->finish(), 0);
  EXPECT_TRUE(has(directory->printed(), " hellos=3 redirected=2 no_game=1"));
}

TEST_F(LobbyTest, PlayersAreSentToARoomOfTheirGame) {
  const GameProgram rooms("dfserver",
                          {{"NAIAD_BUS", bus.url()},
                           {"NAIAD_BUS_ID", "rooms"},
                           {"NAIAD_BUS_INTERVAL", kQuickInterval},
                           {"NAIAD_PUBLIC_HOST", "127.0.0.1"}},
                          {"--room=hall=hello", "--room=small=maze,max-players=1", "--room=large=maze"});
  ASSERT_NE(rooms.port(), 0) << rooms.log();
  ASSERT_NO_FATAL_FAILURE(startDirectory(1));
  const auto ann = join(lobby, "ann", "", "small");
  const auto bob = join(lobby, "bob", "maze");
  ASSERT_TRUE(ann->joined() && bob->joined()) << ann->connection().message() << bob->connection().message();
  EXPECT_EQ(ann->session().welcome().room, "small");
  EXPECT_EQ(bob->session().welcome().room, "large") << "the other one is full";
  EXPECT_EQ(bob->session().welcome().game, "maze");
  const auto eve = join(lobby, "eve");
  ASSERT_TRUE(eve->joined()) << eve->connection().message();
  EXPECT_EQ(eve->session().welcome().room, "hall") << "the first";
}

TEST_F(LobbyTest, FullServerRedirectsToAServerWithFreeSlots) {
  const auto small = startServer("small", 1);
  const auto large = startServer("large", 8);
  ASSERT_NO_FATAL_FAILURE(startDirectory(2));
  const auto ann = join(small->port(), "ann");
  ASSERT_TRUE(ann->joined());
  // Retries, because the directory and the servers learn of each other's state only after some time.
  std::unique_ptr<TestClient> bob;
  for (int tries = 0; tries < 200; ++tries) {
    bob = join(small->port(), "bob");
    if (bob->joined()) break;
    serve({ann.get()}, [end = std::chrono::steady_clock::now() + 100ms] {
      return std::chrono::steady_clock::now() > end;
    });
  }
  ASSERT_TRUE(bob->joined()) << bob->connection().message();
  EXPECT_EQ(bob->connection().address().port, large->port());
  EXPECT_EQ(ann->connection().address().port, small->port());
}

TEST_F(LobbyTest, LobbyRedirectsDuringABusOutage) {
  const auto server = startServer("berlin", 8);
  ASSERT_NO_FATAL_FAILURE(startDirectory(1));
  bus.kill();
  ASSERT_TRUE(directory->prints("the bus cannot be reached"));
  const auto ann = join(lobby, "ann");
  EXPECT_TRUE(ann->joined()) << ann->connection().message();
}

/// A lobby on its own thread that knows one server.
class RunningLobby {
 public:
  RunningLobby(const std::filesystem::path& identity, const LobbySettings& settings, const Presence& server)
      : m_identity(ServerIdentity::loadOrMake(identity, std::chrono::system_clock::now())),
        m_lobby(m_context, settings, m_identity.tls(), m_servers) {
    m_servers.handleHeartbeat(presenceSubject(server.id), server.payload(), std::chrono::steady_clock::now());
    m_thread = std::thread([this] { m_context.run(); });
  }
  ~RunningLobby() { end(); }
  RunningLobby(const RunningLobby&) = delete;
  RunningLobby& operator=(const RunningLobby&) = delete;

  std::uint16_t port() const { return m_lobby.port(); }
  LobbyCounters end() {
    m_context.stop();
    if (m_thread.joinable()) m_thread.join();
    return m_lobby.counters();
  }

 private:
  asio::io_context m_context;
  FleetRegistry m_servers;
  ServerIdentity m_identity;
  Lobby m_lobby;
  std::thread m_thread;
};

TEST_F(LobbyTest, LobbyDropsSilentAndInvalidClientsAndKeepsServing) {
  EXPECT_EQ(LobbySettings().hello_timeout, 5s);
  TestServer server(busyWorld(5), home.server());
  Presence presence = presenceOf("berlin");
  presence.host = "127.0.0.1";
  presence.port = server.port();
  presence.key = server.fingerprint()->text();
  presence.protocol = kProtocolVersion;
  RunningLobby running(home.identity("lobby"), {.address = "127.0.0.1", .hello_timeout = 1s}, presence);
  RawClient silent(running.port(), RawClient::Line::kTls);
  EXPECT_TRUE(silent.waitForHangup());
  RawClient garbage(running.port(), RawClient::Line::kTls);
  garbage.sendFrame("no hello");
  EXPECT_TRUE(garbage.waitForHangup());
  RawClient longer(running.port(), RawClient::Line::kTls);
  longer.sendFrame(std::string(5'000, 'x'));
  EXPECT_TRUE(longer.waitForHangup());
  RawClient twice(running.port(), RawClient::Line::kTls);
  twice.send(RawClient::hello("ann"));
  twice.send(RawClient::hello("ann"));
  ASSERT_TRUE(twice.receive());
  EXPECT_TRUE(twice.waitForHangup()) << "one answer";
  EXPECT_TRUE(join(running.port(), "ann")->joined());
  const LobbyCounters met = running.end();
  EXPECT_EQ(met.hellos, 2u);
  EXPECT_EQ(met.malformed, 1u);
  EXPECT_EQ(met.timeouts, 1u);
}

Presence lobbyServer(const std::string& id) {
  return presenceOf(id, 0, 2);
}

wire::ClientMessage hello(const std::string& game = "", std::uint32_t protocol = 4) {
  wire::ClientMessage message = RawClient::hello("ann");
  message.mutable_hello()->set_protocol(protocol);
  message.mutable_hello()->set_game(game);
  return message;
}

/// The answers of a lobby that knows a server with two places.
struct LobbyReplyTest : testing::Test {
  LobbyReplyTest() { handleHeartbeat(servers, lobbyServer("a")); }
  wire::Refused answerTo(const wire::ClientMessage& message) {
    const auto answer = replyToHello(message.SerializeAsString(), servers);
    wire::ServerMessage said;
    EXPECT_TRUE(answer && said.ParseFromString(answer->frame));
    return said.refused();
  }

  FleetRegistry servers;
};

TEST_F(LobbyReplyTest, RedirectNamesTheRoomSeparatelyAndInTheMessage) {
  Presence server = lobbyServer("a");
  server.rooms = {{"hall", "lobby", 0, 2}, {"duel", "tron", 0, 2}};
  handleHeartbeat(servers, server);
  const wire::Refused refused = answerTo(hello("tron"));
  EXPECT_EQ(refused.reason(), wire::Refused::REDIRECT);
  EXPECT_EQ(refused.redirect(), linkOf(server)) << "as clients know it that know no rooms";
  EXPECT_EQ(refused.redirect_room(), "duel");
  EXPECT_NE(refused.message().find(linkOf(server, "duel")), std::string::npos) << refused.message();
  wire::ClientMessage wish = hello();
  wish.mutable_hello()->set_room("duel");
  EXPECT_EQ(answerTo(wish).redirect_room(), "duel");
  wish.mutable_hello()->set_room("cellar");
  EXPECT_EQ(answerTo(wish).reason(), wire::Refused::GAME);
  EXPECT_NE(answerTo(wish).message().find("cellar"), std::string::npos);
}

TEST_F(LobbyReplyTest, PlayersGetABusyReplyWhenServersAreFull) {
  answerTo(hello());
  answerTo(hello());
  const wire::Refused refused = answerTo(hello());
  EXPECT_EQ(refused.reason(), wire::Refused::BUSY);
  EXPECT_EQ(refused.redirect(), "");
}

TEST_F(LobbyReplyTest, UnknownGameOrProtocolIsRefusedWithTheReason) {
  EXPECT_EQ(answerTo(hello("maze")).reason(), wire::Refused::GAME);
  EXPECT_NE(answerTo(hello("maze")).message().find("maze"), std::string::npos);
  EXPECT_EQ(answerTo(hello("", 5)).reason(), wire::Refused::GAME);
  EXPECT_EQ(answerTo(hello("\033[2J")).message().find('\033'), std::string::npos);
  Presence newer = lobbyServer("b");
  newer.protocol = 5;
  handleHeartbeat(servers, newer);
  EXPECT_EQ(answerTo(hello("", 5)).reason(), wire::Refused::REDIRECT) << "it knows each version's servers";
}

TEST_F(LobbyReplyTest, InvalidHelloGetsNoReplyAndReservesNoSlot) {
  wire::ClientMessage other = hello();
  other.mutable_hello()->set_magic(7);
  EXPECT_FALSE(replyToHello(other.SerializeAsString(), servers));
  other.mutable_leave();
  EXPECT_FALSE(replyToHello(other.SerializeAsString(), servers));
  EXPECT_FALSE(replyToHello("", servers));
  SplitMix64 random(5);
  for (int i = 0; i < 2'000; ++i) {
    std::string bytes(random.next() % 200, '\0');
    for (char& c : bytes) c = static_cast<char>(random.next());
    EXPECT_FALSE(replyToHello(bytes, servers));
  }
  EXPECT_EQ(answerTo(hello()).reason(), wire::Refused::REDIRECT);
  EXPECT_EQ(answerTo(hello()).reason(), wire::Refused::REDIRECT) << "both places are free";
}

}  // namespace
}  // namespace naiad::test
