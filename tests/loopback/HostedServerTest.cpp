// Host actions on a server: shutdown, reload of options, restart. Real processes and sockets.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "ProgramFixture.h"
#include "host/auth/PasswordHash.h"
#include "host/auth/ServerIdentity.h"
#include "shared/net/stream/ProxyHeader.h"
#include "tests/server/host/admin/Talk.h"
#include "tests/support/RunProgram.h"
#include "tests/support/net/HttpClient.h"

namespace naiad::test {
namespace {

namespace fs = std::filesystem;

std::string cheapHash(const std::string& password) {
  return PasswordHash::of(password, {.memory_kib = 64, .passes = 1}).text();
}

class HostedServer : public ProgramFixture {
 protected:
  HostedServer() { fs::create_directories(home.identity("files")); }

  fs::path config() const { return home.identity("files") / "server.conf"; }
  void writeConfig(const std::string& lines) const {
    std::ofstream(config()) << lines;
    fs::permissions(config(), fs::perms::owner_read | fs::perms::owner_write);
  }
  void start(std::map<std::string, std::string> environment, const std::string& options = "") {
    writeConfig(options);
    environment.insert({"NAIAD_GAME", "hello"});
    launch("dfserver", std::move(environment), {"--config", config()});
  }
  TestClient& client(const ClientSetup& setup) {
    m_clients.push_back(connect(setup));
    m_clients.back()->keepPictures(false);
    return *m_clients.back();
  }
  TestClient& join(const std::string& name) { return join(home.player(name)); }
  TestClient& join(const ClientSetup& setup) {
    TestClient& joining = client(setup);
    EXPECT_TRUE(joins(joining)) << game->log();
    return joining;
  }
  /// Returns the message with which a client is refused; empty if it joins.
  std::string refusal(const ClientSetup& setup) { return LoopbackFixture::refusal(client(setup)); }
  bool reload(const std::string& options) {
    writeConfig(options);
    game->signal(SIGHUP);
    return serve([this] {
      return has(game->log(), "options reloaded: ") || has(game->log(), "the options were not changed: ");
    });
  }
  bool isTold(TestClient& playing, const std::string& line) {
    return serve([&] { return heard(playing, line); });
  }
  bool endsWell() const {
    const int status = game->wait();
    return WIFEXITED(status) && WEXITSTATUS(status) == 0;
  }

  std::pair<int, std::string> ctl(const std::string& command) const { return game->ctl(command); }

 private:
  std::vector<std::unique_ptr<TestClient>> m_clients;
};

// ---- shutdown ---------------------------------------------------------------------------------------------

TEST_F(HostedServer, SigtermLetsPlayersFinish) {
  start({{"NAIAD_DRAIN_TIMEOUT", "3000"}});
  TestClient& ann = join("ann");
  ann.session().sendChat("hello all");
  EXPECT_TRUE(isTold(ann, "hello all"));
  game->signal(SIGTERM);
  EXPECT_TRUE(
      isTold(ann, "The server shuts down when all players have left, or in 3000 seconds at the latest."));
  EXPECT_EQ(refusal(home.player("bob")), "The server is shutting down and accepts no new players.");
  EXPECT_TRUE(waitForTicks(ann));
  ann.connection().leave();
  EXPECT_TRUE(waitForLog("\" left: quit\n"));
  EXPECT_TRUE(endsWell());
  EXPECT_TRUE(has(game->log(), " refused_closing=1 "));
  EXPECT_FALSE(has(game->log(), "hello all")) << "chat is not logged by default";
}

TEST_F(HostedServer, ADrainHasADeadline) {
  start({{"NAIAD_DRAIN_TIMEOUT", "1"}});
  TestClient& ann = join("ann");
  const auto begin = Clock::now();
  game->signal(SIGTERM);
  EXPECT_TRUE(isDismissed(ann, "The server is shutting down."));
  const auto took = Clock::now() - begin;
  EXPECT_GE(took, std::chrono::milliseconds(950));
  EXPECT_LE(took, std::chrono::seconds(2)) << "a second more than it was given";
  EXPECT_TRUE(endsWell());
}

TEST_F(HostedServer, SigintEndsAtOnce) {
  start({{"NAIAD_DRAIN_TIMEOUT", "3000"}});
  TestClient& ann = join("ann");
  game->signal(SIGINT);
  EXPECT_TRUE(isDismissed(ann, "The server is shutting down."));
  EXPECT_TRUE(endsWell());
}

// ---- options ----------------------------------------------------------------------------------------------

TEST_F(HostedServer, ReloadChangesThePasswordForNewPlayers) {
  start({}, "password = " + cheapHash("old") + "\n");
  ClientSetup old = home.player("ann");
  old.options.password = "old";
  TestClient& ann = join(old);
  ASSERT_TRUE(reload("password = " + cheapHash("new") + "\n"));
  EXPECT_TRUE(waitForLog("options reloaded: password has changed\n")) << game->log();
  EXPECT_EQ(refusal(old), "That is not this server's password.");
  ClientSetup bob = home.player("bob");
  bob.options.password = "new";
  join(bob);
  EXPECT_TRUE(waitForTicks(ann));
  EXPECT_FALSE(has(game->log(), "$argon2")) << "not even its hash is logged";
}

TEST_F(HostedServer, ReloadTakesANewCertificateNotAMissingOne) {
  const auto now = std::chrono::system_clock::now();
  const fs::path files = home.identity("files");
  const ServerIdentity first = ServerIdentity::loadOrMake(home.identity("first"), now);
  const ServerIdentity second = ServerIdentity::loadOrMake(home.identity("second"), now);
  const auto use = [&](const std::string& which) {
    for (const char* p_name : {"certificate.pem", "key.pem"}) {
      fs::copy_file(home.identity(which) / p_name, files / p_name, fs::copy_options::overwrite_existing);
    }
  };
  const std::string options = "certificate = " + (files / "certificate.pem").string() +
                              "\nkey = " + (files / "key.pem").string() + "\n";
  use("first");
  start({}, options);
  ClientSetup ann = home.player("ann");
  ann.trust.fingerprint = first.fingerprint();
  TestClient& playing = join(ann);
  use("second");
  ASSERT_TRUE(reload(options));
  EXPECT_TRUE(waitForLog("warning: the server's key has changed")) << game->log();
  ClientSetup bob = home.player("bob");
  bob.trust.fingerprint = second.fingerprint();
  bob.trust.known_servers = home.identity("bobs_servers");
  join(bob);
  fs::remove(files / "key.pem");
  game->signal(SIGHUP);
  EXPECT_TRUE(waitForLog("the options were not changed: ")) << game->log();
  bob.options.name = "cid";
  join(bob);
  EXPECT_TRUE(waitForTicks(playing));
}

// ---- the log ----------------------------------------------------------------------------------------------

TEST_F(HostedServer, JsonLogLinesHaveEventFields) {
  start({{"NAIAD_LOG_FORMAT", "json"}, {"NAIAD_LOG_CHAT", "true"}});
  TestClient& ann = join("ann");
  ann.session().sendChat("hello \"all\"");
  ASSERT_TRUE(waitForLog("\"chat\""));
  ann.connection().leave();
  ASSERT_TRUE(waitForLog("\"left\""));
  std::map<std::string, nlohmann::json> events;
  std::istringstream lines(game->log());
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with('{')) continue;  // not a log line: text that the server prints for its host
    const auto event = nlohmann::json::parse(line);
    events[event.at("event")] = event;
  }
  EXPECT_EQ(events.at("joined").at("player"), "ann");
  EXPECT_EQ(events.at("joined").at("program"), "test");
  EXPECT_EQ(events.at("joined").at("address").get<std::string>().rfind("127.0.0.1:", 0), 0u);
  EXPECT_EQ(events.at("chat").at("line"), "hello \"all\"");
  EXPECT_EQ(events.at("left").at("reason"), "quit");
}

/// Returns the result of the shipped fail2ban filter on the server's log, for example "Lines: 9 lines, 0
/// ignored, 2 matched, …".
std::string fail2banFinds(const GameProgram& server, const std::string& mode) {
  const std::string command = "fail2ban-regex '" + (server.directory() / "log").string() + "' '" +
                              NAIAD_SOURCE_DIR "/deploy/fail2ban/naiad.conf[mode=" + mode + "]' 2>&1";
  const std::string text = runProgram(command).second;
  const std::size_t at = text.find("Lines: ");
  return at == std::string::npos ? text : text.substr(at, text.find('\n', at) - at);
}

class Fail2ban : public HostedServer, public testing::WithParamInterface<const char*> {
 protected:
  void SetUp() override {
    if (std::system("command -v fail2ban-regex >/dev/null") != 0) GTEST_SKIP() << "there is no fail2ban";
  }
};

TEST_P(Fail2ban, MatchesOnlyWrongPasswordsInNormalMode) {
  start({{"NAIAD_LOG_FORMAT", GetParam()}, {"NAIAD_PASSWORD", cheapHash("xyzzy")}, {"NAIAD_LOG_CHAT", "1"}});
  ClientSetup ann = home.player("ann");
  ann.options.password = "xyzzy";
  TestClient& playing = join(ann);
  // Chat that imitates the beginning of another log line, and another field of a JSON line.
  playing.session().sendChat("203.0.113.9:1 refused: \"That is not this server's password");
  playing.session().sendChat(
      "\",\"address\":\"203.0.113.9:1\",\"sentence\":\"That is not this server's password");
  ASSERT_TRUE(waitForLog("sentence\\"));
  ClientSetup other = home.player("bob");
  other.options.game = "203.0.113.9:1 refused: ";
  EXPECT_NE(refusal(other), "");
  ASSERT_TRUE(waitForLog("This server plays"));
  EXPECT_TRUE(has(fail2banFinds(*game, "normal"), " 0 matched,"));
  EXPECT_TRUE(has(fail2banFinds(*game, "aggressive"), " 1 matched,"));
  ClientSetup guess = home.player("eve");
  guess.options.password = "plugh";
  // Retries until a refusal is logged: at most one a second is logged per address, and bob's was just logged.
  ASSERT_TRUE(serve([&] {
    EXPECT_NE(refusal(guess), "");
    const std::string log = game->log();
    return log.find("server's password.") != std::string::npos ||
           log.find("Too many wrong passwords.") != std::string::npos;
  }));
  EXPECT_TRUE(has(fail2banFinds(*game, "normal"), " 1 matched,")) << game->log();
}

INSTANTIATE_TEST_SUITE_P(Formats, Fail2ban, testing::Values("text", "json"),
                         [](const auto& test) { return std::string(test.param); });

// ---- restart ----------------------------------------------------------------------------------------------

using HostedWorld = LoopbackFixture;

TEST_F(HostedWorld, DrainWaitsForADisconnectedPlayer) {
  TestServer server([](df::World&) {}, home.server());
  ClientSetup setup = home.player("ann");
  setup.sessions = home.sessions();
  auto killed = std::make_unique<TestClient>(context, server.port(), setup);
  ASSERT_TRUE(serveUntil(context, {killed.get()}, [&] { return killed->joined(); }));
  killed.reset();
  ASSERT_TRUE(serveUntil(context, {}, [&] { return server.counters().detached == 1; }));
  server.end({.at = Clock::now() + std::chrono::hours(1), .when_empty = true});
  TestClient ann(context, server.port(), setup);
  EXPECT_TRUE(serveUntil(context, {&ann}, [&] { return ann.joined() || ann.connection().isOver(); }));
  ASSERT_TRUE(ann.joined()) << ann.connection().message();
  EXPECT_TRUE(ann.session().isResumed());
}

TEST_F(HostedWorld, ClientWithoutReconnectEndsAtARestart) {
  TestServer server([](df::World&) {}, home.server());
  ClientSetup setup = home.player("ann");
  setup.rejoin = false;
  TestClient ann(context, server.port(), setup);
  ASSERT_TRUE(joins(ann));
  server.end({.is_restart = true, .at = Clock::now()});
  EXPECT_TRUE(ends(ann));
  EXPECT_EQ(ann.connection().message(), "The server is restarting. Your client reconnects automatically.");
}

// ---- restart by dfctl -------------------------------------------------------------------------------------

class Restarts : public HostedServer, public testing::WithParamInterface<const char*> {
 protected:
  /// Returns how often dfserver has started, by its line "hosts". It does not match those of world processes,
  /// which have a mark after the time.
  std::size_t begun() const {
    const std::regex line("\\n[-0-9]+ [:0-9]+ dfserver \\S+ hosts ");
    const std::string lines = "\n" + game->log();
    return static_cast<std::size_t>(
        std::distance(std::sregex_iterator(lines.begin(), lines.end(), line), {}));
  }
};

TEST_P(Restarts, ServerRestartsOnItsPortAndPlayersReconnect) {
  start({{"NAIAD_ON_GAME_OVER", GetParam()}});
  ClientSetup setup = home.player("ann");
  setup.sessions = home.sessions();
  TestClient& ann = join(setup);
  EXPECT_EQ(ctl("restart in 1h").second, "The server restarts in 3600 s.\n");
  EXPECT_TRUE(isTold(ann, "The server restarts in 3600 seconds. Your client reconnects automatically."));
  EXPECT_EQ(ctl("cancel"), std::pair(0, std::string("Cancelled: the server stays up.\n")));
  EXPECT_TRUE(isTold(ann, "The server stays up: its shutdown or restart was cancelled."));
  const auto [code, text] = ctl("restart");
  EXPECT_EQ(code, 0);
  EXPECT_EQ(text, "The server restarts now.\n");
  EXPECT_TRUE(serve([&] { return ann.connection().state() == Connection::State::kReconnecting; }));
  EXPECT_EQ(ann.connection().message(), "The server is restarting. Your client reconnects automatically.");
  EXPECT_TRUE(serve([&] { return ann.joined(); })) << ann.connection().message();
  EXPECT_EQ(begun(), 2u) << game->log();
  EXPECT_TRUE(waitForTicks(ann));
  // The restarted server takes commands at the old path.
  EXPECT_TRUE(has(ctl("who").second, "ann"));
  EXPECT_EQ(ctl("stop maintenance until eight").first, 0);
  EXPECT_TRUE(isDismissed(ann, "maintenance until eight"));
  EXPECT_TRUE(endsWell());
}

INSTANTIATE_TEST_SUITE_P(Worlds, Restarts, testing::Values("exit", "restart"),
                         [](const auto& test) { return std::string(test.param); });

TEST_F(HostedServer, DfctlReloadReportsTheResult) {
  start({}, "max-players = 3\n");
  TestClient& ann = join("ann");
  writeConfig("max-players = 2\nworld-memory = 1000\n");
  EXPECT_EQ(ctl("reload"),
            std::pair(0, std::string(
                             "options reloaded: max-players has changed; world-memory needs a restart.\n")));
  EXPECT_EQ(ctl("set max-players").second, "max-players: 2\n");
  writeConfig("max-plyers = 4\n");
  const auto [code, text] = ctl("reload");
  EXPECT_EQ(code, 1);
  EXPECT_TRUE(has(text, "there is no option \"max-plyers\"; did you mean max-players?"));
  EXPECT_EQ(ctl("set max-players").second, "max-players: 2\n");
  EXPECT_TRUE(waitForTicks(ann));
}

/// Runs `job` a hundred times a second in a thread of its own until it is destroyed. count() returns the
/// number of runs.
class Repeated {
 public:
  explicit Repeated(std::function<void()> job)
      : m_thread([this, job = std::move(job)] {
          for (auto next = Clock::now(); !m_stopping; next += std::chrono::milliseconds(10)) {
            std::this_thread::sleep_until(next);
            job();
            ++m_count;
          }
        }) {}
  ~Repeated() {
    m_stopping = true;
    m_thread.join();
  }
  Repeated(const Repeated&) = delete;
  Repeated& operator=(const Repeated&) = delete;

  int count() const { return m_count; }

 private:
  std::atomic<bool> m_stopping = false;
  std::atomic<int> m_count = 0;
  std::thread m_thread;
};

// With the thread sanitizer, the server exits with another code if it finds a race.
TEST_F(HostedServer, GameSurvives100ScrapesCommandsAndReloadsPerSecond) {
  start({{"NAIAD_METRICS", "127.0.0.1:0"}}, "max-players = 9\n");
  const std::string where = "metrics are at http://127.0.0.1:";
  ASSERT_TRUE(waitForLog(where)) << game->log();
  const std::string log = game->log();
  const auto metrics = static_cast<std::uint16_t>(std::stoi(log.substr(log.find(where) + where.size())));
  TestClient& ann = join("ann");
  std::atomic<int> bad = 0;
  {
    const Repeated scrapes([&] { bad += HttpClient::get(metrics, "/metrics").status == 200 ? 0 : 1; });
    const Repeated orders([&] {
      Talk talk(game->control());
      bad += talk.ask(R"({"command":"status"})").find(R"("ok":true)") == std::string::npos ? 1 : 0;
      bad += talk.ask(R"({"command":"who"})").find("ann") == std::string::npos ? 1 : 0;
    });
    const Repeated reloads([&] {
      Talk talk(game->control());
      const std::string answer = talk.ask(R"({"command":"reload"})");
      bad += answer.find("reload") == std::string::npos ? 1 : 0;  // also if one is in progress
    });
    for (int i = 0; i < 5; ++i) join("bob").connection().leave();
    EXPECT_TRUE(
        serve([&] { return scrapes.count() >= 200 && orders.count() >= 200 && reloads.count() >= 200; }));
  }
  EXPECT_EQ(bad, 0);
  EXPECT_TRUE(waitForTicks(ann));
  EXPECT_EQ(ctl("stop").first, 0);
  EXPECT_TRUE(endsWell()) << game->log();
}

TEST_F(HostedServer, ConnectionDroppedBeforeTlsIsLogged) {
  start({{"NAIAD_PROXY_SOCKET", home.identity("visitors")}});
  ASSERT_EQ(ctl("ban 192.0.2.0/24").first, 0);
  ClientSetup eve = home.player("eve");
  eve.options.proxy = ProxyOptions{home.identity("visitors"), *proxiedPeerFromText("192.0.2.7:50000")};
  EXPECT_NE(refusal(eve), "");
  EXPECT_TRUE(waitForLog("192.0.2.7:50000 refused: \"This address is banned.\"")) << game->log();
}

}  // namespace
}  // namespace naiad::test
