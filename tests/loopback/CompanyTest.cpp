// Players of one server affect each other only as intended: joining, leaving, refusal, chat, stalled clients.
#include <gtest/gtest.h>

#include "Compare.h"
#include "LoopbackFixture.h"
#include "RawClient.h"
#include "engine/world/ObjectRegistry.h"
#include "engine/world/Player.h"

namespace naiad::test {
namespace {

using Reason = wire::Refused;

/// Ticks in five seconds at the default rate.
constexpr std::uint32_t kFiveSeconds = 150;

int countShips(df::World& world) {
  return world.objects().objectsOfType("Ship").getCount();
}

using Company = LoopbackFixture;

TEST_F(Company, KilledClientIsShownAsGone) {
  TestServer server(busyWorld(10));
  TestClient ann(context, server.port(), "ann");
  RawClient bob(server.port());
  bob.send(RawClient::hello("bob"));
  ASSERT_TRUE(serveUntil(context, {&ann}, [&] { return lists(ann, "bob"); }));
  EXPECT_EQ(server.inWorld(countShips), 2);
  bob.reset();
  ASSERT_TRUE(serveUntil(context, {&ann}, [&] { return lists(ann, "ann") && !lists(ann, "bob"); }));
  EXPECT_EQ(server.inWorld(countShips), 1);
}

TEST_F(Company, LeavingOnPurposeRemovesTheShip) {
  TestServer server(busyWorld(10));
  TestClient ann(context, server.port(), "ann");
  ASSERT_TRUE(joins(ann));
  ann.connection().leave();
  ASSERT_TRUE(serveUntil(context, {&ann}, [&] { return server.inWorld(countShips) == 0; }));
}

TEST_F(Company, StalledClientDoesNotDisturbOthers) {
  TestServer server(busyWorld(300));
  TestClient ann(context, server.port(), "ann");
  TestClient bob(context, server.port(), "bob");
  ASSERT_TRUE(serveUntil(context, {&ann, &bob}, [&] { return ann.joined() && bob.joined(); }));
  RawClient stalled(server.port());
  stalled.send(RawClient::hello("mud"));
  bob.keepPictures(false);

  // The client `mud` neither reads nor acknowledges anything.
  const std::uint32_t begin = ann.newestTick();
  ASSERT_TRUE(serveUntil(context, {&ann, &bob}, [&] { return ann.newestTick() > begin + kFiveSeconds; }));
  // Ann received every tick, and all her pictures were correct.
  EXPECT_EQ(ann.session().state(), ClientSession::State::kPlaying);
  expectSame(ann, server, kFiveSeconds - 1);
}

TEST_F(Company, StalledClientCatchesUpWhenItReadsAgain) {
  TestServer server(busyWorld(300));
  asio::io_context asleep;  // mud is stalled while the test does not poll this context
  TestClient ann(context, server.port(), "ann");
  TestClient mud(asleep, server.port(), "mud");
  ASSERT_TRUE(serveUntil(asleep, {&mud}, [&] { return mud.joined(); }));
  const std::uint32_t begin = mud.newestTick();
  ASSERT_TRUE(
      serveUntil(context, {&ann}, [&] { return ann.joined() && ann.newestTick() > begin + kFiveSeconds; }));
  const std::uint32_t stalled_until = ann.newestTick();
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

TEST_F(Company, DuplicateNamesBecomeUnique) {
  TestServer server(busyWorld(5));
  TestClient ann(context, server.port(), "Ann");
  TestClient other(context, server.port(), "ann");
  ASSERT_TRUE(serveUntil(context, {&ann, &other}, [&] { return ann.joined() && other.joined(); }));
  EXPECT_NE(ann.session().welcome().name, other.session().welcome().name);
}

wire::Refused refusalOf(std::uint16_t port, const wire::ClientMessage& hello) {
  RawClient client(port);
  client.send(hello);
  const auto answer = client.receive();
  EXPECT_TRUE(answer && answer->has_refused());
  EXPECT_TRUE(client.waitForHangup());
  return answer ? answer->refused() : wire::Refused();
}

TEST_F(Company, RefusalsExplainTheirReason) {
  HostOptions options = fastOptions();
  options.max_players = 1;
  TestServer server(busyWorld(5), options);

  wire::ClientMessage hello = RawClient::hello("old");
  hello.mutable_hello()->set_protocol(kProtocolVersion - 1);
  EXPECT_EQ(refusalOf(server.port(), hello).reason(), Reason::VERSION);
  EXPECT_TRUE(has(refusalOf(server.port(), hello).message(), "update the client"));
  hello.mutable_hello()->set_protocol(kProtocolVersion + 1);
  EXPECT_TRUE(has(refusalOf(server.port(), hello).message(), "update the server"));

  hello = RawClient::hello("lost");
  hello.mutable_hello()->set_game("chess");
  EXPECT_EQ(refusalOf(server.port(), hello).message(), "This server plays \"test\", not \"chess\".");
  EXPECT_EQ(refusalOf(server.port(), RawClient::hello("\x1b\n ")).reason(), Reason::NAME);

  TestClient ann(context, server.port(), "ann");
  ASSERT_TRUE(joins(ann));
  EXPECT_EQ(refusalOf(server.port(), RawClient::hello("late")).reason(), Reason::FULL);
}

TEST_F(Company, PlayersGetAGoodbyeWhenTheServerEnds) {
  TestServer server(busyWorld(5));
  TestClient ann(context, server.port(), "ann");
  ASSERT_TRUE(joins(ann));
  std::thread stopper([&server] { server.stop("Closing time."); });
  EXPECT_TRUE(ends(ann));
  stopper.join();
  EXPECT_EQ(ann.connection().state(), Connection::State::kEnded);
  EXPECT_EQ(ann.connection().message(), "Closing time.");
}

}  // namespace
}  // namespace naiad::test
