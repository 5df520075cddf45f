#include <gtest/gtest.h>

#include <array>
#include <asio/executor_work_guard.hpp>
#include <asio/io_context.hpp>
#include <chrono>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "host/auth/PasswordHash.h"
#include "tests/server/host/rooms/HostRooms.h"
#include "tests/support/Text.h"

namespace naiad {
namespace {

using namespace std::chrono_literals;
using test::Client;
using test::helloOf;

constexpr int kTurns = 100;  ///< turns of a round that is replayed

/// A world that closes at once, or only when the test allows it.
struct ClosingWorld : test::FakeWorld {
  explicit ClosingWorld(std::shared_ptr<const bool> may_end) : m_may_end(std::move(may_end)) {}

  void tick(const SentTurn&) override {}
  std::optional<WorldEnd> end() const override { return *m_may_end ? ended : std::nullopt; }
  void answer(int ticks) {
    while (ticks-- > 0) reportTick();
  }

 private:
  const std::shared_ptr<const bool> m_may_end;
};

class AdmissionTest : public testing::Test, protected test::HostRooms {
 protected:
  AdmissionTest() { options.max_players = 3; }

  static wire::Hello returning(const Client& client) {
    wire::Hello hello = helloOf("Ann");
    hello.set_resume_token(client.welcome().resume_token());
    return hello;
  }
  Session& sessionOf(std::uint64_t id) { return *sessions.find(id); }
  /// A player joins from `address` and leaves at once. False if the player was refused as BUSY.
  bool visit(const std::string& address) {
    Client& client = greet(helloOf("Ann"), address);
    const bool welcome = client.isWelcome();
    if (welcome)
      leave(client);
    else
      EXPECT_EQ(client.refusal(), wire::Refused::BUSY);
    sessions.sweep();
    rooms.checkWorlds();
    if (sessions.isEmpty()) clients.clear();
    return welcome;
  }
  int joinClass(int pupils) {
    int welcome = 0;
    std::vector<Client*> all;
    for (int i = 0; i < pupils; ++i) all.push_back(&greet(helloOf("Ann")));
    for (const Client* client : all) {
      welcome += client->isWelcome() ? 1 : 0;
      if (client->isWelcome()) leave(*client);
    }
    sessions.sweep();
    rooms.checkWorlds();
    return welcome;
  }
  /// Opens a world that replays a killed server's round, up to `percent` of its turns.
  ClosingWorld& recover(int percent) {
    ClosingWorld* p_fake = nullptr;
    rooms.setWorlds([this, &p_fake](asio::io_context&) {
      auto fake = std::make_unique<ClosingWorld>(worlds_may_end);
      p_fake = fake.get();
      std::string records;
      TurnRecordWriter writer;
      for (int i = 0; i < kTurns; ++i) writer.write(WorldTurn(), records);
      Round::JournalBinding book = test::ringJournal();
      book.recovery =
          std::make_unique<RoundRecovery>(std::make_shared<UnfinishedRound>(DfrHeader(), records));
      return std::make_unique<Round>(std::move(fake), std::move(book));
    });
    admission();
    p_fake->answer(percent);
    return *p_fake;
  }
  void endRecovery(ClosingWorld& fake, int percent) {
    fake.answer(kTurns - percent + 1);  // one more answer for the closing turn
    rooms.checkWorlds();
  }
  bool waitsAfter(const Client& client, std::chrono::milliseconds time) {
    now += time;
    admission().evaluateWaiting();
    return !client.isWelcome() && !client.isRefused();
  }
  /// True if the list of players, which never changes here, is sent.
  bool sendsList() {
    bool sent = false;
    news.tick(
        PlayerListBroadcaster::kInterval, {{.id = 1, .name = "Ann"}}, [](std::uint32_t) { return 0u; },
        [&sent](std::uint32_t, const wire::ServerMessage&) { sent = true; });
    return sent;
  }
  long worlds() const { return worlds_may_end.use_count() - 1; }
  void playInPrivate() {
    options.players = "private";
    rooms.setWorlds([this](asio::io_context&) {
      return std::make_unique<Round>(std::make_unique<ClosingWorld>(worlds_may_end));
    });
  }

  asio::io_context& io = context.home;
  const std::shared_ptr<bool> worlds_may_end = std::make_shared<bool>(true);
};

TEST_F(AdmissionTest, NamesCannotForgeLogLines) {
  wire::Hello hello = helloOf("A\" joined with");
  hello.set_program("x\"\n192.0.2.9:1 \"Bob\" left");
  greet(hello, "192.0.2.1:1");
  ASSERT_EQ(log.size(), 1u);
  EXPECT_EQ(log[0], R"(192.0.2.1:1 "A\" joined with" joined with "x\" 192.0.2.9:1 \"Bob\" left")");
}

TEST_F(AdmissionTest, HelloCreatesAPlayerAndGetsAWelcome) {
  const Client& ann = greet(helloOf("Ann"));
  ASSERT_TRUE(sendsList());
  ASSERT_FALSE(sendsList()) << "nothing has changed";
  const Client& bob = greet(helloOf("Ann"));
  ASSERT_TRUE(ann.isWelcome() && bob.isWelcome());
  EXPECT_EQ(ann.welcome().name(), "Ann");
  EXPECT_NE(bob.welcome().name(), "Ann") << "names differ";
  EXPECT_NE(ann.welcome().player(), bob.welcome().player());
  EXPECT_NE(ann.welcome().color(), bob.welcome().color());
  EXPECT_EQ(ann.welcome().game(), "maze");
  EXPECT_EQ(ann.welcome().grace_millis(), 60'000u);
  EXPECT_NE(rooms.findPlayer(ann.welcome().player()), nullptr);
  EXPECT_EQ(counters.joined, 2u);
  EXPECT_TRUE(sendsList()) << "the newcomer has none";
}

TEST_F(AdmissionTest, HelloWaitsOneSecondForARunningReplay) {
  ClosingWorld& room = recover(50);
  const Client& client = greet(helloOf("Ann"));
  EXPECT_TRUE(waitsAfter(client, 999ms));
  EXPECT_FALSE(waitsAfter(client, 1ms));
  EXPECT_EQ(client.refusal(), wire::Refused::BUSY);
  endRecovery(room, 50);
  EXPECT_TRUE(greet(helloOf("Ann")).isWelcome());
}

TEST_F(AdmissionTest, HelloWaitsForAReplayMoreThanHalfDone) {
  ClosingWorld& room = recover(40);
  const Client& client = greet(helloOf("Ann"));
  EXPECT_TRUE(waitsAfter(client, 999ms));
  room.answer(11);
  EXPECT_TRUE(waitsAfter(client, 2000ms));
  endRecovery(room, 51);
  EXPECT_FALSE(waitsAfter(client, 0ms));
  EXPECT_TRUE(client.isWelcome());
}

TEST_F(AdmissionTest, HelloWaitsAtMostThreeSecondsForAReplay) {
  recover(99);
  const Client& client = greet(helloOf("Ann"));
  EXPECT_TRUE(waitsAfter(client, 2999ms));
  EXPECT_FALSE(waitsAfter(client, 1ms));
  EXPECT_EQ(client.refusal(), wire::Refused::BUSY);
}

TEST_F(AdmissionTest, AnotherVersionOrGameIsRefused) {
  wire::Hello hello = helloOf("Ann");
  hello.set_protocol(kProtocolVersion + 1);
  const Client& newer = greet(hello);
  EXPECT_EQ(newer.refusal(), wire::Refused::VERSION);
  EXPECT_TRUE(test::has(newer.sent.front().refused().message(), "update the server"));
  hello.set_protocol(kProtocolVersion - 1);
  EXPECT_TRUE(test::has(greet(hello).sent.front().refused().message(), "update the client"));
  EXPECT_EQ(counters.refused_version, 2u);
  hello.set_protocol(kProtocolVersion);
  hello.set_game("tron");
  EXPECT_EQ(greet(hello).refusal(), wire::Refused::GAME);
  EXPECT_EQ(clients.back().sent.front().refused().message(), R"(This server plays "maze", not "tron".)");
  EXPECT_EQ(counters.refused_game, 1u);
}

TEST_F(AdmissionTest, ANameWithoutPrintableCharactersIsRefused) {
  EXPECT_EQ(greet(helloOf(" \t ")).refusal(), wire::Refused::NAME);
  EXPECT_EQ(counters.refused_name, 1u);
  EXPECT_EQ(counters.joined, 0u);
}

TEST_F(AdmissionTest, PlayerLimitsOfServerAndAddressAreEnforced) {
  options.max_per_address = 1;
  EXPECT_TRUE(greet(helloOf("Ann"), "192.0.2.1:1").isWelcome());
  EXPECT_EQ(greet(helloOf("Bob"), "192.0.2.1:2").refusal(), wire::Refused::FULL);
  EXPECT_EQ(clients.back().sent.front().refused().message(),
            "Too many players from your address (limit 1). Try again later.");
  EXPECT_EQ(counters.refused_address, 1u);
  EXPECT_TRUE(greet(helloOf("Bob"), "192.0.2.2:1").isWelcome());
  EXPECT_TRUE(greet(helloOf("Cid"), "192.0.2.3:1").isWelcome());
  EXPECT_EQ(greet(helloOf("Dan"), "192.0.2.4:1").refusal(), wire::Refused::FULL);
  EXPECT_EQ(counters.refused_full, 1u);
}

TEST_F(AdmissionTest, DisconnectedPlayersCountAgainstTheAddressLimit) {
  options.max_per_address = 1;
  Client& ann = greet(helloOf("Ann"));
  ann.drop();
  EXPECT_EQ(greet(helloOf("Bob")).refusal(), wire::Refused::FULL);
  EXPECT_EQ(counters.refused_address, 1u);
  EXPECT_EQ(sessions.playingCount(), 1u);
  EXPECT_TRUE(greet(returning(ann)).isWelcome()) << "coming back takes no place";
  admission().forgetSession(sessionOf(1));
  EXPECT_TRUE(greet(helloOf("Cid")).isWelcome());
}

TEST_F(AdmissionTest, ResumedPlayerCountsAtOldAndNewAddress) {
  options.max_per_address = 1;
  Client& ann = greet(helloOf("Ann"), "192.0.2.1:1");
  greet(helloOf("Bob"), "192.0.2.2:1");
  ann.drop();
  EXPECT_TRUE(greet(returning(ann), "192.0.2.2:2").welcome().resumed()) << "although the address is full";
  EXPECT_EQ(greet(helloOf("Cid"), "192.0.2.1:2").refusal(), wire::Refused::FULL)
      << "moving on frees no place for another one";
  EXPECT_EQ(greet(helloOf("Cid"), "192.0.2.2:3").refusal(), wire::Refused::FULL);
  EXPECT_TRUE(greet(helloOf("Cid"), "192.0.2.3:1").isWelcome());
}

TEST_F(AdmissionTest, RapidResumeIsRefusedAndKeepsItsToken) {
  Client* p_ann = &greet(helloOf("Ann"));
  const std::uint32_t player = p_ann->welcome().player();
  const auto comeBack = [&](bool new_process) {
    p_ann->drop();
    wire::Hello hello = returning(*p_ann);
    hello.set_new_process(new_process);
    Client& back = greet(hello);
    if (back.isWelcome()) p_ann = &back;
    return back.isWelcome();
  };
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(comeBack(i % 2 == 0));
  wire::Hello hello = returning(*p_ann);
  p_ann->drop();
  for (int i = 0; i < 10; ++i) {
    hello.set_new_process(i % 2 == 0);
    EXPECT_EQ(greet(hello).refusal(), wire::Refused::BUSY);
    sessions.sweep();
  }
  EXPECT_EQ(counters.resumes_deferred, 10u);
  EXPECT_EQ(counters.unknown_tokens, 0u);
  EXPECT_TRUE(sessionOf(1).isDetached());
  now += 1s;
  hello.set_new_process(false);
  const Client& back = greet(hello);
  ASSERT_TRUE(back.isWelcome());
  EXPECT_EQ(back.welcome().player(), player);
  EXPECT_EQ(counters.resumed, 4u);
  EXPECT_EQ(sessions.playingCount(), 1u);
}

TEST_F(AdmissionTest, OldTokenIsInvalidOnceTheNextIsConfirmed) {
  Client& ann = greet(helloOf("Ann"));
  ann.drop();
  const Client& back = greet(returning(ann));
  EXPECT_TRUE(back.welcome().resumed());
  EXPECT_EQ(back.welcome().player(), ann.welcome().player());
  EXPECT_NE(back.welcome().resume_token(), ann.welcome().resume_token());
  EXPECT_FALSE(sessionOf(1).isDetached());
  admission().confirmToken(sessionOf(1));
  const Client& late = greet(returning(ann));
  EXPECT_EQ(counters.unknown_tokens, 1u);
  EXPECT_NE(late.welcome().player(), ann.welcome().player()) << "a new player";
}

TEST_F(AdmissionTest, ClientIsRefusedAfterItsSessionResumedElsewhere) {
  Client& ann = greet(helloOf("Ann"));
  ASSERT_TRUE(sendsList());
  wire::Hello new_process = returning(ann);
  new_process.set_new_process(true);
  const Client& other = greet(new_process);
  ASSERT_TRUE(other.isWelcome());
  EXPECT_TRUE(sendsList()) << "the new process has none";
  admission().confirmToken(sessionOf(1));
  EXPECT_EQ(greet(returning(ann)).refusal(), wire::Refused::SESSION_MOVED);
  EXPECT_EQ(counters.refused_session_moved, 1u);
}

TEST_F(AdmissionTest, ForgottenSessionCannotBeResumed) {
  Client& ann = greet(helloOf("Ann"));
  admission().forgetSession(sessionOf(1));
  greet(returning(ann));
  EXPECT_EQ(counters.unknown_tokens, 1u);
  EXPECT_EQ(sessions.playingCount(), 2u);
}

TEST_F(AdmissionTest, SecondStreamNeedsTokenOfAConnectedSession) {
  wire::Hello second = helloOf("Ann");
  second.set_second_stream(true);
  second.set_resume_token("no token");
  EXPECT_EQ(greet(second).refusal(), wire::Refused::BAD_REQUEST);
  Client& ann = greet(helloOf("Ann"));
  second.set_resume_token(ann.welcome().resume_token());
  greet(second);
  EXPECT_TRUE(sessionOf(2).hasSecondStream());
  ann.drop();
  EXPECT_EQ(greet(second).refusal(), wire::Refused::BAD_REQUEST);
  EXPECT_EQ(counters.unknown_tokens, 2u);
  EXPECT_EQ(counters.joined, 1u);
}

TEST_F(AdmissionTest, RapidSecondStreamsAreRefusedAsBusy) {
  Client& ann = greet(helloOf("Ann"));
  wire::Hello second = returning(ann);
  second.set_second_stream(true);
  for (int i = 0; i < 4; ++i) EXPECT_TRUE(greet(second).isWelcome()) << i;
  for (int i = 0; i < 100; ++i) {
    EXPECT_EQ(greet(second).refusal(), wire::Refused::BUSY);
    sessions.sweep();
  }
  EXPECT_EQ(counters.second_streams, 4u);
  EXPECT_EQ(counters.second_streams_deferred, 100u);
  EXPECT_EQ(counters.unknown_tokens, 0u);
  EXPECT_TRUE(sessionOf(1).hasSecondStream()) << "the one it has stays";
  EXPECT_FALSE(sessionOf(1).isDetached());
  ann.drop();
  const Client& back = greet(returning(ann));
  ASSERT_TRUE(back.isWelcome()) << "the token stays good";
  second.set_resume_token(back.welcome().resume_token());
  EXPECT_EQ(greet(second).refusal(), wire::Refused::BUSY) << "coming back refills nothing";
  for (int i = 0; i < 20; ++i) {
    now += 2s;  // as often as clients retry
    EXPECT_TRUE(greet(second).isWelcome()) << i;
  }
}

TEST_F(AdmissionTest, APasswordIsNeededByNewPlayersOnly) {
  options.password = PasswordHash::of("open sesame", {.memory_kib = 64, .passes = 1}).text();
  const auto work = asio::make_work_guard(io);
  const auto answered = [this](const Client& client) {
    for (int i = 0; i < 100 && client.sent.empty(); ++i) io.run_one_for(1s);
    return !client.sent.empty();
  };
  wire::Hello hello = helloOf("Ann");
  hello.set_password("open barley");
  Client& wrong = greet(hello);
  EXPECT_TRUE(wrong.sent.empty()) << "it is being checked";
  ASSERT_TRUE(answered(wrong));
  EXPECT_EQ(wrong.refusal(), wire::Refused::PASSWORD);
  EXPECT_EQ(counters.refused_password, 1u);
  EXPECT_EQ(admission().passwordCounters().wrong, 1u);
  hello.set_password("open sesame");
  Client& right = greet(hello);
  ASSERT_TRUE(answered(right));
  ASSERT_TRUE(right.isWelcome());
  right.drop();
  EXPECT_TRUE(greet(returning(right)).isWelcome()) << "at once, by its token";
}

TEST_F(AdmissionTest, PasswordResultAfterDisconnectAdmitsNoPlayer) {
  options.password = PasswordHash::of("open sesame", {.memory_kib = 64, .passes = 1}).text();
  const auto work = asio::make_work_guard(io);
  wire::Hello hello = helloOf("Ann");
  hello.set_password("open sesame");
  greet(hello).drop();
  sessions.sweep();
  ASSERT_EQ(io.run_one_for(60s), 1u) << "the answer";
  EXPECT_EQ(counters.joined, 0u);
  EXPECT_TRUE(sessions.isEmpty());
}

TEST_F(AdmissionTest, PasswordsBeyondTheQueueAreCountedAsBusy) {
  options.password = PasswordHash::of("open sesame", {.memory_kib = 64, .passes = 1}).text();
  const auto work = asio::make_work_guard(io);
  wire::Hello hello = helloOf("Ann");
  hello.set_password("open barley");
  for (int i = 0; i < 20; ++i) greet(hello, "192.0." + std::to_string(i) + ".1:1");
  for (int i = 0; i < 100 && counters.refused_busy + counters.refused_password < 20; ++i) io.run_one_for(1s);
  EXPECT_EQ(counters.refused_busy + counters.refused_password, 20u);
  EXPECT_GE(counters.refused_busy, 10u) << "eight places";
  EXPECT_EQ(admission().passwordCounters().busy, counters.refused_busy);
}

TEST_F(AdmissionTest, ClassOf64AtOneAddressRejoinsImmediately) {
  options.max_players = 64;
  EXPECT_EQ(joinClass(64), 64);
  EXPECT_EQ(joinClass(64), 64);
  EXPECT_EQ(counters.refused_busy, 0u);
  EXPECT_EQ(joinClass(64), 0) << "enough for now";
  now += 32s;
  EXPECT_EQ(joinClass(64), 64);
}

TEST_F(AdmissionTest, RepeatedJoinsFromOneAddressAreRateLimited) {
  int joins = 0;
  for (int i = 0; i < 1000; ++i, now += 10ms) joins += visit("192.0.2.1:1") ? 1 : 0;
  EXPECT_LE(joins, 128 + 2 * 10);
  EXPECT_GE(joins, 128 + 2 * 10 - 1);
  EXPECT_EQ(counters.refused_busy, 1000u - static_cast<unsigned>(joins));
  EXPECT_TRUE(visit("192.0.2.2:1")) << "another address";
}

TEST_F(AdmissionTest, JoinsFromManyAddressesShareTheNetworkLimit) {
  int joins = 0;
  for (int i = 0; i < 2000; ++i, now += 5ms) {
    std::array<char, 64> address{};
    std::snprintf(address.data(), address.size(), "[2001:db8:1:%x::1]:1", i);
    joins += visit(address.data()) ? 1 : 0;
  }
  EXPECT_LE(joins, 512 + 8 * 10);
  EXPECT_TRUE(visit("[2001:db8:2::1]:1")) << "another network";
}

TEST_F(AdmissionTest, SchoolClassOf64RejoinsPrivateWorldsImmediately) {
  options.max_players = 64;
  playInPrivate();
  EXPECT_EQ(joinClass(64), 64);
  EXPECT_EQ(worlds(), 0) << "they have left";
  EXPECT_EQ(joinClass(64), 64) << "and are back";
}

TEST_F(AdmissionTest, NewWorldsAreLimitedPerAddressAndInTotal) {
  options.max_players = 100;
  playInPrivate();
  int joins = 0;
  for (int i = 0; i < 1000; ++i, now += 10ms) joins += visit("192.0.2.1:1") ? 1 : 0;
  EXPECT_LE(joins, 128 + 10);
  EXPECT_GE(joins, 128 + 10 - 1);
  now += 1h;
  joins = 0;
  for (int i = 0; i < 1000; ++i, now += 10ms) {
    joins += visit("198.51." + std::to_string(i % 200) + ".1:1") ? 1 : 0;
  }
  EXPECT_LE(joins, 200 + 8 * 10);
  EXPECT_GE(joins, 200 + 8 * 10 - 1);
}

TEST_F(AdmissionTest, WorldsStillEndingCountAgainstTheLimit) {
  playInPrivate();
  *worlds_may_end = false;
  int joins = 0;
  for (int i = 0; i < 20; ++i, now += 1s) joins += visit("192.0.2.1:1") ? 1 : 0;
  EXPECT_EQ(joins, 3 + 8) << "one for each player allowed, and a few that are ending";
  EXPECT_EQ(worlds(), 3 + 8);
  *worlds_may_end = true;
  rooms.checkWorlds();
  EXPECT_TRUE(visit("192.0.2.1:1"));
}

TEST_F(AdmissionTest, FailedWorldStartRefusesItsClientAndIsLogged) {
  options.players = "private";
  rooms.setWorlds([](asio::io_context&) -> std::unique_ptr<Round> {
    throw std::system_error(std::make_error_code(std::errc::too_many_files_open), "a new world");
  });
  EXPECT_EQ(greet(helloOf("Ann")).refusal(), wire::Refused::BUSY);
  EXPECT_EQ(counters.refused_busy, 1u);
  ASSERT_EQ(log.size(), 1u) << "in the log of clients alone: in others a client could write without end";
  EXPECT_TRUE(log[0].starts_with("192.0.2.1:1 cannot join: a new world: ")) << log[0];
}

TEST_F(AdmissionTest, HelloAfterWorldsWereClosedIsRefused) {
  admission();
  rooms.closeWorlds();
  EXPECT_EQ(greet(helloOf("Ann")).refusal(), wire::Refused::BUSY);
  EXPECT_EQ(counters.joined, 0u);
}

}  // namespace
}  // namespace naiad
