// Players of one server affect each other only as intended: stalled clients, chat, votes for a pause.
#include <gtest/gtest.h>

#include "Compare.h"
#include "LoopbackFixture.h"
#include "RawClient.h"
#include "engine/widgets/Pause.h"

namespace naiad::test {
namespace {

/// Ticks in five seconds at the default rate.
constexpr std::uint32_t kFiveSeconds = 150;

using Company = LoopbackFixture;

TEST_F(Company, StalledClientDelaysNoneAndCatchesUp) {
  TestServer server(busyWorld(300));
  asio::io_context asleep;  // mud is stalled while the test does not poll this context
  TestClient ann(context, server.port(), "ann");
  TestClient mud(asleep, server.port(), "mud");
  ASSERT_TRUE(serveUntil(asleep, {&mud}, [&] { return mud.joined(); }));
  ASSERT_TRUE(joins(ann) && hears(ann, 1));
  ASSERT_TRUE(hears(ann, kFiveSeconds + 1));
  const std::uint32_t stalled_until = ann.newestTick();
  // Ann received every tick, and all her pictures were correct.
  EXPECT_EQ(ann.session().state(), ClientSession::State::kPlaying);
  expectSame(ann, server, kFiveSeconds - 1);
  // When mud reads again, it soon shows the server's picture.
  EXPECT_TRUE(serveUntil(asleep, {&mud}, [&] {
    return mud.newestTick() > stalled_until + 50 && !mud.pictures().empty() &&
           mud.pictures().rbegin()->first > stalled_until && showsTheTruth(mud, server);
  }));
}

TEST_F(Company, ChatReachesAllPlayersSanitized) {
  TestServer server(busyWorld(5));
  TestClient ann(context, server.port(), "ann");
  TestClient bob(context, server.port(), "bob");
  ASSERT_TRUE(serveUntil(context, {&ann, &bob}, [&] { return lists(ann, "bob") && lists(bob, "ann"); }));
  ann.session().sendChat("hi \x1b[2Jthere");
  ASSERT_TRUE(serveUntil(context, {&ann, &bob},
                         [&] { return !bob.session().chat().empty() && !ann.session().chat().empty(); }));
  EXPECT_EQ(bob.session().chat().back().name, "ann");
  EXPECT_EQ(bob.session().chat().back().text, "hi ?[2Jthere");
}

TEST_F(Company, PauseIsAVoteShownToAllPlayers) {
  TestServer server([](df::World&) { new df::Pause(df::Keyboard::P); });
  TestClient ann(context, server.port(), "ann");
  TestClient bob(context, server.port(), "bob");
  const auto until = [&](const auto& done) { return serveUntil(context, {&ann, &bob}, done); };
  const auto is_paused = [](df::World& world) { return world.isPaused(); };
  ASSERT_TRUE(until([&] { return lists(ann, "bob") && lists(bob, "ann"); }));
  press(ann, df::Keyboard::P);
  ASSERT_TRUE(until([&] { return hasRead(ann, "pause: 1 of 2") && hasRead(bob, "pause: 1 of 2"); }));
  EXPECT_FALSE(server.inWorld(is_paused));
  press(bob, df::Keyboard::P);
  ASSERT_TRUE(until([&] { return hasRead(ann, "pause: 2 of 2"); }));
  EXPECT_TRUE(server.inWorld(is_paused));
}

using Chat = LoopbackFixture;

TEST_F(Chat, RejoiningDoesNotRaiseTheChatLimitPerAddress) {
  constexpr std::uint64_t kVisits = 200;
  TestServer server([](df::World&) {});
  TestClient ann(context, server.port(), "ann");
  ASSERT_TRUE(joins(ann));
  const auto began = Clock::now();
  std::uint64_t joins = 0;
  for (std::uint64_t i = 0; i < kVisits; ++i) {
    ann.connection().update(Clock::now());
    context.restart();
    context.poll();
    RawClient client(server.port());
    client.send(RawClient::hello("revenant"));
    const auto answer = client.receive();
    if (!answer || !answer->has_welcome()) continue;
    ++joins;
    wire::ClientMessage line, leave;
    line.mutable_chat()->set_text("again");
    for (std::uint32_t number = 1; number <= 3; ++number) {  // as many as a new player may send
      line.set_number(number);
      client.send(line);
    }
    leave.mutable_leave();
    client.send(leave);
    client.waitForHangup();
  }
  const auto seconds = std::chrono::duration<double>(Clock::now() - began).count();
  const Counters counters = server.counters();
  EXPECT_LE(static_cast<double>(joins), 128 + 2 * seconds);
  EXPECT_EQ(counters.refused_busy, kVisits - joins);
  const std::uint64_t lines = 3 * joins - counters.chat_dropped;
  EXPECT_LE(static_cast<double>(lines), 192 + 16 * seconds);
  EXPECT_GE(lines, 192u);
  EXPECT_TRUE(serve(ann, [&] { return ann.session().counters().chat_lines >= lines; }));
  EXPECT_EQ(ann.session().counters().chat_lines, lines) << "what she heard";
}

}  // namespace
}  // namespace naiad::test
