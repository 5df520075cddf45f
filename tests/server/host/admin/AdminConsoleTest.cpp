#include <gtest/gtest.h>

#include <asio/executor_work_guard.hpp>
#include <asio/io_context.hpp>
#include <asio/post.hpp>
#include <map>
#include <optional>
#include <set>

#include "FakeTarget.h"
#include "host/admin/AdminConsole.h"
#include "shared/admin/AdminText.h"

namespace naiad {
namespace {

using namespace std::chrono_literals;
using Level = AdminCommand::Level;
using Place = AdminCommand::Place;

class AdminConsoleTest : public testing::Test {
 protected:
  ~AdminConsoleTest() override { worker.finish(); }

  static AdminCaller socket() { return {Level::kAdmin, Place::kSocket, "user 0, process 1"}; }
  static AdminCaller player(const std::string& name, std::uint64_t session, Level level = Level::kPlayer) {
    return {level, Place::kChat, "player " + name, name, session};
  }
  /// Carry it out, and wait for the answer.
  AdminAnswer give(const std::vector<std::string>& words, const AdminCaller& caller = socket()) {
    std::optional<AdminAnswer> answer;
    io.restart();
    console.execute(readAdminRequest(words), caller,
                    [&answer](AdminAnswer given) { answer = std::move(given); });
    const auto work = asio::make_work_guard(io);
    while (!answer) io.run_one();
    return *answer;
  }

  test::FakeTarget target;
  AdminWorker worker;
  BanList bans{worker, {}, [this] { return now; }};
  Ban::Time now{1'800'000'000s};
  std::vector<std::string> log;
  asio::io_context io;
  AdminConsole console{{target, worker, bans, [this](const std::string& line) { log.push_back(line); },
                        [this](std::function<void()> job) { asio::post(io, std::move(job)); }}};
};

TEST_F(AdminConsoleTest, ScoresAreAskedForByTableAndCount) {
  EXPECT_TRUE(give({"scores"}).ok);
  EXPECT_EQ(target.done.back(), "scores  10");
  EXPECT_TRUE(give({"scores", "pilots", "10000"}).ok);
  EXPECT_EQ(target.done.back(), "scores pilots 10000");
  for (const std::string count : {"0", "10001", "-1", "x", "1x"})
    EXPECT_FALSE(give({"scores", "pilots", count}).ok) << count;
  EXPECT_TRUE(give({"scores", "--room", "one", "pilots"}).ok);
  EXPECT_EQ(target.done.back(), "scores pilots 10 room one");
  EXPECT_TRUE(give({"scores", "--game=tron"}).ok);
  EXPECT_EQ(target.done.back(), "scores  10 game tron");
  EXPECT_FALSE(give({"scores", "--room", "one", "--game", "tron"}).ok);
}

TEST_F(AdminConsoleTest, EveryCommandOfTheTableIsCarriedOut) {
  target.add("Ann");
  target.add("Bob", "192.0.2.2:1");
  const std::vector<std::vector<std::string>> all{{"who"},
                                                  {"rooms"},
                                                  {"status"},
                                                  {"say", "hi"},
                                                  {"tell", "Ann", "hi"},
                                                  {"mute", "Ann"},
                                                  {"unmute", "Ann"},
                                                  {"bans"},
                                                  {"scores"},
                                                  {"ban", "198.51.100.1"},
                                                  {"allow", "198.51.100.2"},
                                                  {"unban", "198.51.100.1"},
                                                  {"kick", "Bob"},
                                                  {"password", ""},
                                                  {"set"},
                                                  {"set", "grace", "3"},
                                                  {"reload"},
                                                  {"restart"},
                                                  {"drain"},
                                                  {"cancel"},
                                                  {"stop"},
                                                  {"ping"}};
  std::set<std::string> given{"watch"};  // the socket's own
  for (const auto& words : all) {
    EXPECT_TRUE(give(words).ok) << words.front();
    given.insert(words.front());
  }
  for (const AdminCommand& command : adminCommands()) {
    EXPECT_TRUE(command.place == Place::kChat || given.contains(command.name)) << command.name;
  }
}

TEST_F(AdminConsoleTest, RoomsAreListedAndTheRoomOfEachPlayerWithThem) {
  EXPECT_EQ(give({"rooms"}).text, "This server has no rooms.");
  target.named_rooms = {{{"room", std::string("arcade")}, {"players", std::int64_t{2}}}};
  EXPECT_EQ(give({"rooms"}).rows, target.named_rooms);
  target.add("Ann").room = "arcade";
  const AdminRow row = give({"who"}, player("Eve", 7)).rows.front();
  EXPECT_EQ(std::get<std::string>(row.back().second), "arcade");
}

TEST_F(AdminConsoleTest, PlayersMayDoLittle) {
  target.add("Ann");
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
  EXPECT_TRUE(target.has("Ann"));
  EXPECT_TRUE(target.done.empty());
  EXPECT_TRUE(give({"who"}, player("Eve", 7)).ok);
}

TEST_F(AdminConsoleTest, PlayersSeeNoAddresses) {
  target.add("Ann", "192.0.2.99:50312");
  for (const std::string& line : answerText(give({"who"}, player("Eve", 7))))
    EXPECT_EQ(line.find("192.0.2"), std::string::npos);
  bool shown = false;
  for (const std::string& line : answerText(give({"who"})))
    shown |= line.find("192.0.2.99") != std::string::npos;
  EXPECT_TRUE(shown);
}

TEST_F(AdminConsoleTest, AKickIsToldInWords) {
  target.add("Ann");
  EXPECT_TRUE(give({"kick", "Ann", "too", "loud"}).ok);
  EXPECT_EQ(target.done, (std::vector<std::string>{"end Ann: You were removed from the game: too loud"}));
  EXPECT_FALSE(give({"kick", "Ann"}).ok);
}

TEST_F(AdminConsoleTest, AnAmbiguousNameKicksNobody) {
  target.add("Anna");
  target.add("Annika");
  const AdminAnswer answer = give({"kick", "Ann"});
  EXPECT_FALSE(answer.ok);
  EXPECT_EQ(answer.candidates.size(), 2u);
  EXPECT_EQ(target.all.size(), 2u);
}

TEST_F(AdminConsoleTest, ABanOfAPlayerIsOfTheirNameAndAddress) {
  target.add("Ann", "192.0.2.7:1");
  target.add("Bob", "192.0.2.8:1");
  EXPECT_TRUE(give({"ban", "Ann", "2h", "spam"}).ok);
  EXPECT_FALSE(target.has("Ann"));
  EXPECT_TRUE(target.has("Bob"));
  EXPECT_NE(target.done.front().find("spam"), std::string::npos);
  EXPECT_TRUE(bans.isBanned(asio::ip::make_address("192.0.2.7")));
  EXPECT_NE(bans.refusal(asio::ip::make_address("198.51.100.1"), "Ann"), "");
  now += 2h;
  EXPECT_FALSE(bans.isBanned(asio::ip::make_address("192.0.2.7")));
}

TEST_F(AdminConsoleTest, OneOfAClassIsBannedByNameAlone) {
  target.add("Ann", "192.0.2.7:1");
  target.add("Bob", "192.0.2.7:2");
  const AdminAnswer answer = give({"ban", "Ann"});
  EXPECT_TRUE(answer.ok);
  EXPECT_NE(answer.text.find("By name alone"), std::string::npos) << answer.text;
  EXPECT_FALSE(target.has("Ann"));
  EXPECT_TRUE(target.has("Bob"));
  EXPECT_FALSE(bans.isBanned(asio::ip::make_address("192.0.2.7")));
}

TEST_F(AdminConsoleTest, ARangeThrowsOutThoseWhoPlayThere) {
  target.add("Ann", "192.0.2.7:1");
  target.add("Bob", "192.0.2.8:1");
  target.add("Eve", "198.51.100.1:1");
  EXPECT_TRUE(give({"ban", "192.0.2.0/24"}).ok);
  EXPECT_FALSE(target.has("Ann"));
  EXPECT_FALSE(target.has("Bob"));
  EXPECT_TRUE(target.has("Eve"));
}

TEST_F(AdminConsoleTest, LoopbackAndHalfTheWorldAreNotBanned) {
  target.add("Ann", "127.0.0.1:1");
  for (const char* who : {"127.0.0.1", "127.0.0.0/8", "::1", "0.0.0.0/0", "::/0", "192.0.0.0/7"})
    EXPECT_FALSE(give({"ban", who}).ok) << who;
  EXPECT_TRUE(give({"ban", "Ann"}).ok);
  EXPECT_FALSE(target.has("Ann")) << "by name";
  EXPECT_EQ(bans.now()->all().size(), 1u);
}

TEST_F(AdminConsoleTest, AMistypedNameBansNobody) {
  EXPECT_FALSE(give({"ban", "Anm"}).ok);
  EXPECT_TRUE(give({"ban", "name:Anm"}).ok);
  EXPECT_EQ(give({"bans"}).rows.size(), 1u);
  EXPECT_FALSE(give({"unban", "Nobody"}).ok);
  EXPECT_TRUE(give({"unban", "name:Anm"}).ok);
  EXPECT_TRUE(give({"bans"}).rows.empty());
}

TEST_F(AdminConsoleTest, APasswordIsHashedAndNowhereElse) {
  EXPECT_TRUE(give({"password", "correct horse"}).ok);
  ASSERT_TRUE(target.password);
  EXPECT_TRUE(target.password->matches("correct horse"));
  EXPECT_TRUE(give({"password", ""}).ok);
  EXPECT_FALSE(target.password);
  ASSERT_EQ(log.size(), 2u);
  for (const std::string& line : log) EXPECT_EQ(line.find("horse"), std::string::npos) << line;
}

TEST_F(AdminConsoleTest, TheLogSaysWhoGaveACommand) {
  target.add("Ann");
  give({"kick", "Ann"});
  give({"who"});
  give({"status"});
  ASSERT_EQ(log.size(), 1u) << "what changes nothing has no line";
  EXPECT_EQ(log.front(), "admin: user 0, process 1: kick \"Ann\"");
}

TEST_F(AdminConsoleTest, AMutedPlayerTellsNobodyAnything) {
  const std::uint64_t ann = target.add("Ann").session;
  target.add("Bob", "192.0.2.2:1");
  EXPECT_TRUE(give({"tell", "Bob", "hi"}, player("Ann", ann)).ok);
  EXPECT_TRUE(give({"mute", "Ann"}).ok);
  EXPECT_FALSE(give({"tell", "Bob", "hi"}, player("Ann", ann)).ok);
  EXPECT_EQ(target.done, (std::vector<std::string>{"tell 102: Ann tells you: hi"}));
}

TEST_F(AdminConsoleTest, ARestartHasItsTime) {
  EXPECT_TRUE(give({"restart", "--in", "60s"}).ok);
  EXPECT_TRUE(give({"restart", "--at-round-end"}).ok);
  EXPECT_TRUE(give({"restart", "--keep"}).ok);
  EXPECT_FALSE(give({"restart", "keep", "5s"}).ok);
  EXPECT_FALSE(give({"restart", "in"}).ok);
  EXPECT_FALSE(give({"restart", "now", "60s"}).ok);
  EXPECT_EQ(target.done, (std::vector<std::string>{"restart 2 60", "restart 1 0", "keep"}));
}

}  // namespace
}  // namespace naiad
