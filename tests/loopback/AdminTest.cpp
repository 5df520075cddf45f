// Administers a running server through its control socket, dfctl and chat commands. A client that connects
// through the visitors' socket counts with its visitor's address.
#include <gtest/gtest.h>

#include <algorithm>
#include <asio/local/stream_protocol.hpp>
#include <asio/write.hpp>
#include <chrono>
#include <fstream>
#include <iterator>
#include <regex>
#include <sstream>
#include <thread>
#include <utility>

#include "GameProgram.h"
#include "LoopbackFixture.h"
#include "host/auth/PasswordHash.h"
#include "shared/net/stream/ProxyHeader.h"
#include "tests/server/host/admin/Talk.h"
#include "tests/support/RunProgram.h"

namespace naiad::test {
namespace {

using Local = asio::local::stream_protocol;

std::string command(const std::string& name, const std::string& arguments = "") {
  return R"({"command":")" + name + R"(","arguments":{)" + arguments + "}}";
}

class AdminTest : public LoopbackFixture {
 protected:
  AdminTest() {
    options.visitors = home.identity("visitors");
    options.control = home.identity("control.sock");
    options.state = home.identity("state");
    options.admin_password = PasswordHash::of("open sesame", {.memory_kib = 64, .passes = 1}).text();
  }
  /// Returns the setup of a client that uses the visitors' socket, for example from "192.0.2.7:50312".
  ClientSetup from(const std::string& address, const std::string& name) const {
    ClientSetup setup = home.player(name);
    setup.options.proxy = ProxyOptions{options.visitors, *proxiedPeerFromText(address)};
    return setup;
  }
  bool reads(TestClient& client, const std::string& text) {
    return serve(client, [&] { return hasRead(client, text); });
  }
  /// Repeats a chat line until it is answered, because lines beyond the limits of a player and an address are
  /// dropped.
  bool saysAndReads(TestClient& client, const std::string& line, const std::string& text) {
    const std::size_t before = client.session().chat().size();
    const auto answered = [&] {
      const auto& chat = client.session().chat();
      return std::any_of(
          chat.begin() + static_cast<std::ptrdiff_t>(std::min(before, chat.size())), chat.end(),
          [&text](const ChatEntry& entry) { return entry.text.find(text) != std::string::npos; });
    };
    for (int tries = 0; tries < 20; ++tries) {
      client.session().sendChat(line);
      const auto end = Clock::now() + std::chrono::seconds(1);
      serve(client, [&] { return answered() || Clock::now() > end; });
      if (answered()) return true;
    }
    return false;
  }
  std::string ask(const std::string& line) const { return Talk(options.control).ask(line); }
  /// True if the command succeeds.
  testing::AssertionResult does(const std::string& name, const std::string& arguments) const {
    return has(ask(command(name, arguments)), R"("ok":true)");
  }

  HostOptions options = home.server();
};

TEST_F(AdminTest, KickVoidsTokenAndRemovesPlayerWithinTwoTicks) {
  options.grace = 60;
  TestServer server(busyWorld(5), options);
  ClientSetup setup = home.player("ann");
  setup.sessions = home.sessions();
  TestClient ann(context, server.port(), setup);
  ASSERT_TRUE(joins(ann));
  const std::uint32_t player = ann.player();
  const std::uint32_t joined = ann.newestTick();
  ASSERT_TRUE(serve(ann, [&] { return ann.newestTick() > joined + 5; }));
  ASSERT_TRUE(server.truth(joined + 2, player)) << "they are in the world";
  const std::string answer = ask(command("kick", R"("player":"ann","reason":"too loud")"));
  ASSERT_EQ(answer, R"({"ok":true,"text":"ann was removed."})");
  const auto step = [&server] {
    return server.inWorld([](df::World& world) { return static_cast<std::uint32_t>(world.getStepCount()); });
  };
  const std::uint32_t kicked = step();  // ann was removed in this tick or in the next one
  while (step() < kicked + 2) {
  }
  EXPECT_FALSE(server.truth(kicked + 2, player));
  ASSERT_TRUE(ends(ann));
  EXPECT_TRUE(has(ann.connection().message(), "too loud"));
  TestClient again(context, server.port(), setup);
  ASSERT_TRUE(joins(again)) << "a kick is no ban";
  EXPECT_NE(again.player(), player);
}

/// Returns the bytes that a visitor from this address receives until the server closes the connection.
std::string bytesFor(const std::string& visitors, const std::string& address) {
  asio::io_context context;
  Local::socket socket(context);
  socket.connect(Local::endpoint(visitors));
  std::error_code error;
  asio::write(socket, asio::buffer(proxyHeader(*proxiedPeerFromText(address))), error);
  std::string heard;
  while (!error) {
    char bytes[256];
    heard.append(bytes, socket.read_some(asio::buffer(bytes), error));
  }
  return heard;
}

TEST_F(AdminTest, BanDropsNewConnectionsBeforeTls) {
  TestServer server(busyWorld(5), options);
  TestClient ann(context, server.port(), from("192.0.2.9:50003", "ann"));
  ASSERT_TRUE(joins(ann));
  ASSERT_TRUE(does("ban", R"("who":"192.0.2.0/24","for":"2h")"));
  ASSERT_TRUE(ends(ann));
  // This visitor sends nothing. TlsListenerTest.BannedAddressGetsNoByte also tests one that sends a hello.
  EXPECT_EQ(bytesFor(options.visitors, "192.0.2.7:50001"), "");
  TestClient eve(context, server.port(), from("192.0.2.200:50003", "eve"));
  EXPECT_FALSE(joins(eve));
  TestClient bob(context, server.port(), from("192.0.3.9:50003", "bob"));
  EXPECT_TRUE(joins(bob));
  EXPECT_EQ(server.counters().connections, 2u) << "ann's and bob's: no other one finished a handshake";
}

TEST_F(AdminTest, BannedPlayerIsToldTheReasonAndEndTime) {
  TestServer server(busyWorld(5), options);
  TestClient ann(context, server.port(), from("192.0.2.7:50000", "ann"));
  TestClient bob(context, server.port(), from("192.0.2.8:50000", "bob"));
  ASSERT_TRUE(joins(ann));
  ASSERT_TRUE(joins(bob));
  ASSERT_TRUE(does("ban", R"("who":"ann","for":"7d","reason":"spam")"));
  ASSERT_TRUE(ends(ann));
  const std::string message = ann.connection().message();
  EXPECT_TRUE(has(message, "banned"));
  EXPECT_TRUE(has(message, "until 20"));
  EXPECT_TRUE(has(message, "spam"));
  EXPECT_TRUE(bob.joined());
  // A ban of the name, tried from another address, is refused with a message.
  TestClient again(context, server.port(), from("198.51.100.1:50000", "ann"));
  EXPECT_FALSE(joins(again));
  EXPECT_TRUE(has(again.connection().message(), "banned"));
  EXPECT_EQ(server.counters().refused_banned, 1u);
}

/// Uses the real dfserver and dfctl. dfctl is not a descendant of the server, because the server obeys no
/// descendants.
class CtlTest : public LoopbackFixture {
 protected:
  std::pair<int, std::string> ctl(const std::string& arguments) const { return server.ctl(arguments); }

  GameProgram server{"dfserver", {{"NAIAD_GAME", "hello"}}};
};

TEST_F(CtlTest, CommandsShowStateAndActOnPlayers) {
  TestClient ann(context, server.port(), home.player("ann"));
  ASSERT_TRUE(joins(ann));
  const auto who = ctl("who");
  EXPECT_EQ(who.first, 0);
  EXPECT_TRUE(has(who.second, "ann"));
  const auto json = ctl("who --json");
  EXPECT_EQ(json.second.rfind("[{\"id\":", 0), 0u) << json.second;
  EXPECT_EQ(ctl("ping").first, 0);
  const auto status = ctl("status");
  EXPECT_TRUE(has(status.second, "connected: 1"));
  EXPECT_EQ(ctl("say hello there").first, 0);
  EXPECT_TRUE(serve(ann, [&] { return hasRead(ann, "hello there"); }));
  EXPECT_EQ(ctl("kick ann").first, 0);
  EXPECT_TRUE(serve(ann, [&] { return ann.connection().isOver(); }));
  EXPECT_TRUE(serve(ann, [&] {
    const std::string log = server.log();
    return log.find("admin: user ") != std::string::npos && log.find("kick \"ann\"") != std::string::npos;
  })) << server.log();
}

TEST_F(CtlTest, ExitCodeAndHelpReportTheCommandsResult) {
  EXPECT_EQ(ctl("kick nobody").first, 1);
  EXPECT_EQ(ctl("kick").first, 2);
  EXPECT_EQ(ctl("kik ann").first, 2);
  EXPECT_EQ(ctl("admin secret").first, 2) << "a command of the chat";
  EXPECT_EQ(ctl("").first, 2);
  EXPECT_EQ(runCtl("--control /nowhere/at/all who").first, 3);
  EXPECT_EQ(runCtl("--help").first, 0);
  EXPECT_EQ(runCtl("--version").first, 0);
  EXPECT_EQ(runCtl("completion bash").first, 0);
  EXPECT_EQ(runCtl("completion csh").first, 2);
  EXPECT_TRUE(has(ctl("help drain").second, "drain [SPAN]: "));
  EXPECT_EQ(ctl("help drian").second,
            "dfctl: There is no command \"drian\"; did you mean \"drain\"?\nRun dfctl --help for more "
            "information.\n");
}

TEST_F(CtlTest, ChangedPlayerLimitTakesEffect) {
  TestClient ann(context, server.port(), home.player("ann"));
  ASSERT_TRUE(joins(ann));
  EXPECT_EQ(ctl("set max-players 1").first, 0);
  TestClient bob(context, server.port(), home.player("bob"));
  EXPECT_FALSE(joins(bob));
  EXPECT_EQ(ctl("set max-players 200").first, 0) << "more than it began with";
  TestClient cat(context, server.port(), home.player("cat"));
  EXPECT_TRUE(joins(cat));
}

// ---- in the chat ------------------------------------------------------------------------------------------

TEST_F(AdminTest, ChatCommandsNeverReachOtherPlayers) {
  TestServer server(busyWorld(5), options);
  TestClient bob(context, server.port(), home.player("bob"));
  ASSERT_TRUE(joins(bob));
  int number = 0;
  for (const char* line : {"/admin wrong sesame", "  /admin typo", "\xe2\x80\x8b/admin hidden",
                           "\x01/nonsense secret", "/", "//secret", "/ admin secret"}) {
    // A new player for each line, because one player may send only three lines at once.
    TestClient ann(context, server.port(), home.player("ann" + std::to_string(number++)));
    ASSERT_TRUE(joins(ann));
    const std::size_t before = ann.session().chat().size();
    ann.session().sendChat(line);
    ASSERT_TRUE(serveUntil(context, {&ann, &bob}, [&] { return ann.session().chat().size() > before; }))
        << line;
    if (number == 1) {
      ann.session().sendChat("but this is for all");
      ASSERT_TRUE(serveUntil(context, {&ann, &bob}, [&] { return hasRead(bob, "but this is for all"); }));
    }
  }
  TestClient last(context, server.port(), home.player("last"));
  ASSERT_TRUE(joins(last));
  last.session().sendChat("the end");
  ASSERT_TRUE(serveUntil(context, {&last, &bob}, [&] { return hasRead(bob, "the end"); }));
  for (const char* secret : {"sesame", "typo", "hidden", "secret", "nonsense"})
    EXPECT_FALSE(hasRead(bob, secret)) << secret;
}

TEST_F(AdminTest, ResumeKeepsAMuteButNoAdminRights) {
  options.grace = 60;
  TestServer server(busyWorld(5), options);
  ClientSetup setup = home.player("ann");
  setup.sessions = home.sessions();
  TestClient bob(context, server.port(), home.player("bob"));
  ASSERT_TRUE(joins(bob));
  bob.session().sendChat("/vote kick bob");
  EXPECT_TRUE(reads(bob, "This server does not allow votes.")) << "the default";
  std::uint32_t player = 0;
  {
    TestClient ann(context, server.port(), setup);
    ASSERT_TRUE(joins(ann));
    player = ann.player();
    ann.session().sendChat("/kick bob");
    ASSERT_TRUE(reads(ann, "You may not use the command"));
    ann.session().sendChat("/admin open sesame");
    ASSERT_TRUE(reads(ann, "You are an admin"));
    ann.session().sendChat("/mute bob");
    ASSERT_TRUE(reads(ann, "bob is muted"));
    ASSERT_TRUE(does("mute", R"("player":"ann")"));
  }
  TestClient again(context, server.port(), setup);
  ASSERT_TRUE(joins(again));
  ASSERT_EQ(again.player(), player) << "the same session";
  EXPECT_TRUE(saysAndReads(again, "/kick bob", "You may not use the command"));
  EXPECT_TRUE(bob.joined());
  again.session().sendChat("can you hear me");
  ASSERT_TRUE(serveUntil(context, {&again, &bob}, [&] { return hasRead(again, "You are muted"); }));
  EXPECT_FALSE(hasRead(bob, "can you hear me"));
  EXPECT_EQ(server.counters().chat_muted, 1u);
}

TEST_F(AdminTest, VoteKicksAndBansThePlayer) {
  options.vote_kick = true;
  TestServer server(busyWorld(5), options);
  TestClient ann(context, server.port(), from("192.0.2.1:1", "ann"));
  TestClient bob(context, server.port(), from("192.0.2.2:1", "bob"));
  TestClient eve(context, server.port(), from("192.0.2.3:1", "eve"));
  for (TestClient* p_client : {&ann, &bob, &eve}) ASSERT_TRUE(joins(*p_client));
  ann.session().sendChat("/vote kick eve");
  ASSERT_TRUE(serveUntil(context, {&ann, &bob, &eve}, [&] { return hasRead(bob, "to kick eve"); }));
  bob.session().sendChat("/vote kick eve");
  ASSERT_TRUE(serveUntil(context, {&ann, &bob, &eve}, [&] { return eve.connection().isOver(); }));
  EXPECT_TRUE(has(eve.connection().message(), "voted"));
  TestClient again(context, server.port(), from("192.0.2.4:1", "eve"));
  EXPECT_FALSE(joins(again));
}

TEST_F(AdminTest, InactivePlayerIsWarnedAndKicked) {
  options.inactive_kick = 1;
  for (const int pause_millis : {0, 1500}) {
    TestServer server(busyWorld(5), options);
    TestClient ann(context, server.port(), home.player("ann"));
    ASSERT_TRUE(joins(ann));
    server.inWorld([&](df::World&) {
      std::this_thread::sleep_for(std::chrono::milliseconds(pause_millis));
      return 0;
    });
    ASSERT_TRUE(reads(ann, "Press a key")) << pause_millis;
    ASSERT_TRUE(ends(ann));
    EXPECT_EQ(ann.connection().message(), "Disconnected: no input for 1s.");
    EXPECT_EQ(server.counters().idle_kicks, 1u);
  }
}

/// Runs dfserver with the default settings, but on loopback.
std::pair<int, std::string> runServer(const TempFolder& home, const std::string& arguments) {
  return runProgram("env -i PATH=$PATH HOME=" + home.string() + " XDG_RUNTIME_DIR=" + home.string() + " " +
                    NAIAD_BINARY_DIR "/dfserver --game hello --address 127.0.0.1 " + arguments +
                    " 2>&1 </dev/null");
}

TEST(ServerStart, PrintsTheLinesForPlayersFirst) {
  const TempFolder home;
  const auto [code, output] = runServer(home, "--port 0 --ticks 3");
  EXPECT_EQ(code, 0) << output;
  std::istringstream lines(output);
  std::string line;
  ASSERT_TRUE(std::getline(lines, line));
  EXPECT_TRUE(line.starts_with("Join from this machine with: dfclient naiad://127.0.0.1:")) << output;
  ASSERT_TRUE(std::getline(lines, line));
  EXPECT_TRUE(line.starts_with("Only this machine can join: ")) << output;
  const std::regex shown(R"(\d{4}-\d\d-\d\d [0-9:]{8} (dfserver \S+ hosts \S+ on \S+|game: seed \d+))");
  const std::regex gap(R"(.{19} this kernel has no .*)");
  while (std::getline(lines, line) && !has(line, " stopped: "))
    EXPECT_TRUE(std::regex_match(line, shown) || std::regex_match(line, gap)) << line;
  std::ostringstream page;
  page << std::ifstream(NAIAD_SOURCE_DIR "/docs/hosting.md").rdbuf();
  const std::string text = page.str();
  EXPECT_EQ(std::distance(std::sregex_iterator(text.begin(), text.end(), shown), {}), 2)
      << "docs/hosting.md shows these lines";
}

TEST(ServerStart, SecondOneSaysHowToJoinTheFirst) {
  const TempFolder home;
  GameProgram first("dfserver",
                    {{"NAIAD_GAME", "hello"}, {"NAIAD_CONTROL", ""}, {"XDG_RUNTIME_DIR", home.string()}});
  const std::string port = std::to_string(first.port());
  const auto [code, output] = runServer(home, "--port " + port);
  EXPECT_EQ(code, 4);
  EXPECT_TRUE(has(output, "already running there; join it with: dfclient naiad://127.0.0.1:" + port + "#"));
}

TEST(CtlOfADamagedServer, InvalidBanFileStopsTheStart) {
  const TempFolder home;
  const std::string state = home / "state";
  std::filesystem::create_directory(state);
  std::ofstream(state + "/bans.sqlite3") << "nothing that SQLite wrote";
  const auto [code, output] = runServer(home, "--port 0 --control off --ticks 1 --state " + state);
  EXPECT_EQ(code, 5) << output;
  EXPECT_TRUE(has(output, "ban file"));
}

// ---- the visitors' socket ---------------------------------------------------------------------------------

class VisitorsTest : public AdminTest {
 protected:
  VisitorsTest() { options.max_per_address = 2; }
};

TEST_F(VisitorsTest, PlayersCountForTheirOwnAddress) {
  TestServer server(busyWorld(5), options);
  TestClient ann(context, server.port(), from("192.0.2.7:50312", "ann"));
  TestClient bob(context, server.port(), from("192.0.2.7:50313", "bob"));
  ASSERT_TRUE(joins(ann));
  ASSERT_TRUE(joins(bob));
  TestClient third(context, server.port(), from("192.0.2.7:50314", "cat"));
  EXPECT_NE(refusal(third), "");
  TestClient dan(context, server.port(), from("[2001:db8::7]:50315", "dan"));
  TestClient eve(context, server.port(), home.player("eve"));
  EXPECT_TRUE(joins(dan));
  EXPECT_TRUE(joins(eve)) << "this machine itself has nobody in the game";
  EXPECT_EQ(server.counters().joined, 4u);
}

TEST_F(VisitorsTest, NoHeaderIsReadFromTcp) {
  TestServer server(busyWorld(5), options);
  asio::ip::tcp::socket socket(context);
  socket.connect({asio::ip::make_address("127.0.0.1"), server.port()});
  asio::write(socket, asio::buffer(proxyHeader({asio::ip::make_address("192.0.2.9"), 9})));
  // The server reads the header as a broken TLS hello, so it sends at most a TLS alert and closes the
  // connection.
  socket.non_blocking(true);
  std::string heard;
  TestClient ann(context, server.port(), home.player("ann"));
  EXPECT_TRUE(serve(ann, [&] {
    char bytes[256];
    std::error_code error;
    const std::size_t size = socket.read_some(asio::buffer(bytes), error);
    heard.append(bytes, size);
    return error && error != asio::error::would_block;
  }));
  EXPECT_LE(heard.size(), 7u) << "a TLS record with an alert";
  EXPECT_TRUE(joins(ann));
  EXPECT_EQ(server.counters().connections, 1u);
}

TEST_F(VisitorsTest, MissingVisitorSocketGivesAMessage) {
  TestServer server(busyWorld(5), home.server());
  TestClient ann(context, server.port(), from("192.0.2.7:50312", "ann"));
  EXPECT_TRUE(has(refusal(ann), "Could not connect through")) << ann.connection().message();
}

}  // namespace
}  // namespace naiad::test
