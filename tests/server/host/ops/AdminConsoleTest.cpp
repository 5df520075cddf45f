#include <gtest/gtest.h>

#include <algorithm>
#include <asio/executor_work_guard.hpp>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "engine/world/World.h"
#include "host/loop/HostClients.h"
#include "host/loop/HostControls.h"
#include "host/loop/HostEndpoint.h"
#include "host/ops/AdminConsole.h"
#include "host/world/WorldInProcess.h"
#include "shared/admin/AdminAnswer.h"
#include "shared/admin/AdminRequest.h"
#include "tests/server/host/rooms/Clients.h"
#include "tests/support/FakeChannel.h"
#include "tests/support/TempFolder.h"

namespace naiad {
namespace {

using namespace std::chrono_literals;
using Level = AdminCommand::Level;
using Frontend = AdminCommand::Frontend;

/// The parts of a host, with clients on fake channels. The host does not run.
class AdminConsoleTest : public testing::Test {
 protected:
  AdminConsoleTest() {
    controls.setReload([this] { return context.options; });
  }
  ~AdminConsoleTest() override { worker.finish(); }

  static AdminCaller socket() { return {Level::kAdmin, Frontend::kSocket, "user 0, process 1"}; }
  static AdminCaller player(const std::string& name, std::uint64_t session, Level level = Level::kPlayer) {
    return {level, Frontend::kChat, "player " + name, name, session};
  }
  AdminAnswer give(const std::vector<std::string>& words, const AdminCaller& caller = socket()) {
    std::optional<AdminAnswer> answer;
    context.home.restart();
    console.execute(readAdminRequest(words), caller,
                    [&answer](AdminAnswer given) { answer = std::move(given); });
    const auto work = asio::make_work_guard(context.home);
    while (!answer) context.home.run_one();
    return *answer;
  }
  /// Adds a room; without any, all players share one. Call it before add().
  void addRoom(const std::string& name, const std::string& game) {
    plans.push_back(
        {.name = name, .game = game, .max_players = 8, .ready = {}, .new_world = [this](asio::io_context&) {
           return std::make_unique<Round>(std::make_unique<WorldInProcess>(world));
         }});
  }
  void open() {
    if (std::exchange(is_open, true)) return;
    if (!plans.empty()) clients.setRooms(plans);
    clients.admission().setWorld(world);
    clients.rooms().open(world);
  }
  test::Client& add(const std::string& name, const std::string& address = "192.0.2.1:50000") {
    open();
    test::Client& client = lines.emplace_back();
    client.address = address;
    clients.add(std::make_unique<test::FakeChannel>(client));
    client.greet(test::helloOf(name));
    EXPECT_TRUE(client.isWelcome()) << name;
    return client;
  }
  const Session* find(const std::string& name) const {
    const Session* p_found = nullptr;
    clients.sessions().forEachPlaying([&](const Session& session) {
      if (session.name() == name) p_found = &session;
    });
    return p_found;
  }
  bool has(const std::string& name) const { return find(name) != nullptr; }
  /// Returns the message of the client's goodbye; "" if that was not the last message.
  static std::string goodbye(const test::Client& client) {
    return client.sent.empty() ? "" : client.sent.back().goodbye().message();
  }
  std::vector<std::string> adminLog() const {
    std::vector<std::string> lines_of_admins;
    for (const std::string& line : log) {
      if (line.starts_with("admin: ")) lines_of_admins.push_back(line);
    }
    return lines_of_admins;
  }
  HostOptions options() const {
    HostOptions options;
    options.address = "127.0.0.1";
    options.port = 0;
    options.insecure = true;
    options.grace = 0;
    options.state = folder.string();
    return options;
  }

  const test::TempFolder folder;
  std::vector<std::string> log;
  std::deque<test::Client> lines;
  std::vector<RoomConfig> plans;
  bool is_open = false;
  df::World world;
  const df::World::Scope scope{world};
  HostContext context{options(), "maze", [this](const LogEvent& event) { log.push_back(event.text); }};
  HostEndpoint endpoint{context, [](std::unique_ptr<ReliableChannel>) {}};
  HostClients clients{context, endpoint, [] {}};
  HostControls controls{context, endpoint, clients};
  HostScores scores{{context, endpoint, clients, controls}};
  HostAdmin admin{{context, endpoint, clients, controls}, scores};
  JobThread worker;
  Ban::Time now{1'800'000'000s};
  BanList bans{worker, {}, [this] { return now; }};
  AdminConsole console{context, admin, worker, bans};
};

TEST_F(AdminConsoleTest, ScoresAreAskedForByTableAndCount) {
  std::vector<df::AddedScore> added;
  for (int i = 0; i < 12; ++i) added.push_back({"pilots", {"Ann", i}, 1, i});
  scores.add("maze", {"round", ""}, added);
  EXPECT_EQ(give({"scores"}).rows.size(), 10u);
  EXPECT_EQ(give({"scores", "pilots", "10000"}).rows.size(), 12u);
  EXPECT_TRUE(give({"scores", "others"}).rows.empty());
  for (const std::string count : {"0", "10001", "-1", "x", "1x"})
    EXPECT_FALSE(give({"scores", "pilots", count}).ok) << count;
  EXPECT_EQ(give({"scores", "--room", "one", "pilots"}).text, "This server has no rooms.");
  EXPECT_FALSE(give({"scores", "--game=tron"}).ok);
  EXPECT_FALSE(give({"scores", "--room", "one", "--game", "maze"}).ok);
}

TEST_F(AdminConsoleTest, RoomScoresComeFromTheRoomsGame) {
  addRoom("lobby", "maze");
  addRoom("arcade", "tron");
  open();
  scores.add("tron", {"round", ""}, {{"pilots", {"Ann", 5}, 1, 0}});
  EXPECT_EQ(give({"scores"}).candidates.size(), 2u) << "which game is meant is not said";
  EXPECT_TRUE(give({"scores", "--room", "lobby"}).rows.empty());
  EXPECT_EQ(give({"scores", "--room", "arcade"}).rows.size(), 1u);
  EXPECT_EQ(give({"scores", "--game", "tron"}).rows.size(), 1u);
  EXPECT_NE(give({"scores", "--game", "tronn"}).text.find("did you mean \"tron\""), std::string::npos);
}

TEST_F(AdminConsoleTest, EveryCommandOfTheTableIsCarriedOut) {
  add("Ann");
  add("Bob", "192.0.2.2:1");
  std::istringstream all(
      "who\nrooms\nstatus\nlink\nsay hi\ntell Ann hi\nmute Ann\nunmute Ann\nbans\nscores\n"
      "ban 198.51.100.1\nallow 198.51.100.2\nunban 198.51.100.1\nkick Bob\npassword \"\"\nset\n"
      "set reconnect-time 3\nset grace 3\nreload\nrestart\ndrain\ncancel\nstop\nping\n");
  std::set<std::string> given{"watch", "help"};  // handled by the control socket, and by dfctl and the chat
  for (std::string line; std::getline(all, line);) {
    const std::vector<std::string> words = splitAdminLine(line);
    EXPECT_TRUE(give(words).ok) << line;
    given.insert(words.front());
  }
  for (const AdminCommand& command : adminCommands()) {
    EXPECT_TRUE(command.place == Frontend::kChat || given.contains(command.name)) << command.name;
  }
}

TEST_F(AdminConsoleTest, ListsShowRoomsAndEachPlayersRoom) {
  EXPECT_EQ(give({"rooms"}).text, "This server has no rooms.");
  addRoom("arcade", "tron");
  add("Ann");
  const std::vector<AdminRow> rooms = give({"rooms"}).rows;
  ASSERT_EQ(rooms.size(), 1u);
  EXPECT_EQ(rooms[0][0], (AdminRow::value_type{"room", std::string("arcade")}));
  EXPECT_EQ(rooms[0][2], (AdminRow::value_type{"players", std::int64_t{1}}));
  const AdminRow row = give({"who"}, player("Eve", 7)).rows.front();
  EXPECT_EQ(std::get<std::string>(row.back().second), "arcade");
}

TEST_F(AdminConsoleTest, PlayersCannotUseAdminCommands) {
  add("Ann");
  for (const AdminCommand& command : adminCommands()) {
    if (command.level != Level::kAdmin) continue;
    std::map<std::string, std::string> arguments;
    for (const AdminArgument& argument : command.arguments) {
      if (argument.required) arguments[argument.name] = "Ann";
    }
    std::optional<AdminAnswer> answer;
    console.execute(readAdminRequest(command.name, arguments), player("Eve", 7),
                    [&answer](AdminAnswer given) { answer = std::move(given); });
    ASSERT_TRUE(answer) << command.name;
    EXPECT_FALSE(answer->ok) << command.name;
  }
  EXPECT_TRUE(has("Ann"));
  EXPECT_FALSE(context.shutdown_scheduler.plan());
  EXPECT_TRUE(give({"who"}, player("Eve", 7)).ok);
}

TEST_F(AdminConsoleTest, PlayersSeeNoAddresses) {
  add("Ann", "192.0.2.99:50312");
  for (const std::string& line : answerText(give({"who"}, player("Eve", 7))))
    EXPECT_EQ(line.find("192.0.2"), std::string::npos);
  bool shown = false;
  for (const std::string& line : answerText(give({"who"})))
    shown |= line.find("192.0.2.99") != std::string::npos;
  EXPECT_TRUE(shown);
}

TEST_F(AdminConsoleTest, KickTellsThePlayerTheReason) {
  const test::Client& ann = add("Ann");
  EXPECT_TRUE(give({"kick", "Ann", "too", "loud"}).ok);
  EXPECT_EQ(goodbye(ann), "You were removed from the game: too loud");
  EXPECT_FALSE(give({"kick", "Ann"}).ok);
}

TEST_F(AdminConsoleTest, PlayerBanCoversNameAndAddress) {
  const test::Client& ann = add("Ann", "192.0.2.7:1");
  add("Bob", "192.0.2.8:1");
  EXPECT_TRUE(give({"ban", "Ann", "2h", "spam"}).ok);
  EXPECT_FALSE(has("Ann"));
  EXPECT_TRUE(has("Bob"));
  EXPECT_NE(goodbye(ann).find("spam"), std::string::npos);
  EXPECT_TRUE(bans.isBanned(asio::ip::make_address("192.0.2.7")));
  EXPECT_NE(bans.refusal(asio::ip::make_address("198.51.100.1"), "Ann"), "");
  now += 2h;
  EXPECT_FALSE(bans.isBanned(asio::ip::make_address("192.0.2.7")));
}

TEST_F(AdminConsoleTest, PlayerAtSharedAddressIsBannedByNameOnly) {
  add("Ann", "192.0.2.7:1");
  add("Bob", "192.0.2.7:2");
  const AdminAnswer answer = give({"ban", "Ann"});
  EXPECT_TRUE(answer.ok);
  EXPECT_NE(answer.text.find("Only by name"), std::string::npos) << answer.text;
  EXPECT_FALSE(has("Ann"));
  EXPECT_TRUE(has("Bob"));
  EXPECT_FALSE(bans.isBanned(asio::ip::make_address("192.0.2.7")));
}

TEST_F(AdminConsoleTest, RangeBanKicksPlayersInTheRange) {
  add("Ann", "192.0.2.7:1");
  add("Bob", "192.0.2.8:1");
  add("Eve", "198.51.100.1:1");
  EXPECT_TRUE(give({"ban", "192.0.2.0/24"}).ok);
  EXPECT_FALSE(has("Ann"));
  EXPECT_FALSE(has("Bob"));
  EXPECT_TRUE(has("Eve"));
}

TEST_F(AdminConsoleTest, LoopbackAndHugeRangesCannotBeBanned) {
  add("Ann", "127.0.0.1:1");
  for (const char* who : {"127.0.0.1", "127.0.0.0/8", "::1", "0.0.0.0/0", "::/0", "192.0.0.0/7"})
    EXPECT_FALSE(give({"ban", who}).ok) << who;
  EXPECT_TRUE(give({"ban", "Ann"}).ok);
  EXPECT_FALSE(has("Ann")) << "by name";
  EXPECT_EQ(bans.currentSet()->all().size(), 1u);
}

TEST_F(AdminConsoleTest, UnknownNameIsBannedOnlyWithNamePrefix) {
  EXPECT_FALSE(give({"ban", "Anm"}).ok);
  EXPECT_TRUE(give({"ban", "name:Anm"}).ok);
  EXPECT_EQ(give({"bans"}).rows.size(), 1u);
  EXPECT_FALSE(give({"unban", "Nobody"}).ok);
  EXPECT_TRUE(give({"unban", "name:Anm"}).ok);
  EXPECT_TRUE(give({"bans"}).rows.empty());
}

TEST_F(AdminConsoleTest, PasswordIsSetAndNeverLogged) {
  EXPECT_TRUE(give({"password", "correct horse"}).ok);
  EXPECT_TRUE(clients.admission().needsPassword());
  EXPECT_TRUE(give({"password", ""}).ok);
  EXPECT_FALSE(clients.admission().needsPassword());
  ASSERT_EQ(adminLog().size(), 2u);
  for (const std::string& line : log) EXPECT_EQ(line.find("horse"), std::string::npos) << line;
}

TEST_F(AdminConsoleTest, LogShowsTheCallerOfEachChange) {
  add("Ann");
  give({"kick", "Ann"});
  give({"who"});
  give({"status"});
  ASSERT_EQ(adminLog().size(), 1u) << "what changes nothing has no line";
  EXPECT_EQ(adminLog().front(), "admin: user 0, process 1: kick \"Ann\"");
}

TEST_F(AdminConsoleTest, MutedPlayerCannotSendPrivateMessages) {
  add("Ann");
  const test::Client& bob = add("Bob", "192.0.2.2:1");
  const std::uint64_t ann = find("Ann")->id();
  EXPECT_TRUE(give({"tell", "Bob", "hi"}, player("Ann", ann)).ok);
  EXPECT_TRUE(give({"mute", "Ann"}).ok);
  EXPECT_FALSE(give({"tell", "Bob", "hi"}, player("Ann", ann)).ok);
  const auto told = std::ranges::count_if(bob.sent, [](const wire::ServerMessage& message) {
    return message.chat().text() == "Ann tells you: hi";
  });
  EXPECT_EQ(told, 1);
}

TEST_F(AdminConsoleTest, RestartIsScheduledReplacedAndCancelled) {
  open();
  const auto soon = ShutdownScheduler::Time::clock::now() + 61s;
  EXPECT_TRUE(give({"restart", "--in", "60s"}).ok);
  ASSERT_TRUE(context.shutdown_scheduler.plan());
  EXPECT_TRUE(context.shutdown_scheduler.isRestart());
  EXPECT_LT(context.shutdown_scheduler.plan()->at, soon);
  EXPECT_GT(context.shutdown_scheduler.plan()->at, soon - 2s);
  EXPECT_TRUE(give({"restart", "--at-round-end"}).ok);
  EXPECT_TRUE(context.shutdown_scheduler.plan()->at_round_end);
  EXPECT_NE(give({"restart", "--keep"}).text.find("requires dfserver with --journal"), std::string::npos);
  EXPECT_TRUE(context.shutdown_scheduler.plan()->at_round_end) << "as before";
  EXPECT_FALSE(give({"restart", "keep", "5s"}).ok);
  EXPECT_FALSE(give({"restart", "in"}).ok);
  EXPECT_FALSE(give({"restart", "now", "60s"}).ok);
  EXPECT_TRUE(give({"cancel"}).ok);
  EXPECT_FALSE(context.shutdown_scheduler.plan());
  EXPECT_FALSE(give({"cancel"}).ok);
}

TEST_F(AdminConsoleTest, OnlyChangeableOptionsCanBeSet) {
  open();
  EXPECT_TRUE(give({"set", "max-players", "5"}).ok);
  EXPECT_EQ(context.options.max_players, 5);
  EXPECT_EQ(give({"set", "max-players"}).facts, (AdminRow{{"max-players", std::string("5")}}));
  EXPECT_FALSE(give({"set", "max-players", "-5"}).ok);
  EXPECT_FALSE(give({"set", "port", "1"}).ok);
  EXPECT_EQ(context.options.max_players, 5);
}

TEST_F(AdminConsoleTest, UnknownOptionSuggestsASimilarOne) {
  for (const std::vector<std::string>& value : {std::vector<std::string>{}, {"5"}}) {
    std::vector<std::string> words{"set", "max-plyers"};
    words.insert(words.end(), value.begin(), value.end());
    EXPECT_EQ(give(words).text,
              "\"max-plyers\" cannot be changed while the server runs; did you mean \"max-players\"?");
    words[1] = "game";
    EXPECT_EQ(give(words).text,
              "\"game\" cannot be changed while the server runs; \"set\" lists the options that can.");
  }
}

TEST_F(AdminConsoleTest, StatusHasTheCommandToJoin) {
  open();
  const std::string link = give({"link"}).text;
  EXPECT_EQ(link, "dfclient " + endpoint.joinArguments());
  const AdminRow status = give({"status"}).facts;
  EXPECT_NE(std::find(status.begin(), status.end(), AdminRow::value_type{"join", link}), status.end());
}

}  // namespace
}  // namespace naiad
