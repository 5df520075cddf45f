// Joining, leaving, being refused, talking, stalling: what players of one server do to each other.
#include <gtest/gtest.h>

#include <algorithm>

#include "BusyWorld.h"
#include "Compare.h"
#include "RawClient.h"
#include "TestClient.h"
#include "TestServer.h"
#include "engine/world/ObjectRegistry.h"
#include "engine/world/Player.h"

namespace naiad::test {
namespace {

using Reason = wire::Refused;

/// Ticks in five seconds of real play.
constexpr std::uint32_t kFiveSeconds = 150;

int countShips(df::World& world) {
  return world.objects().objectsOfType("Ship").getCount();
}

bool lists(TestClient& client, const std::string& name) {
  if (!client.joined()) return false;
  const auto& players = client.session().players();
  return std::any_of(players.begin(), players.end(),
                     [&](const PlayerLine& line) { return line.name == name; });
}

TEST(Company, KilledClientIsShownAsGone) {
  TestServer server([](df::World& world) { populateBusyWorld(world, 10); });
  asio::io_context context;
  TestClient ann(context, server.port(), "ann");
  RawClient bob(server.port());
  bob.send(RawClient::hello("bob"));
  ASSERT_TRUE(serveUntil(context, {&ann}, [&] { return lists(ann, "bob"); }));
  EXPECT_EQ(server.inWorld(countShips), 2);
  bob.reset();
  ASSERT_TRUE(serveUntil(context, {&ann}, [&] { return lists(ann, "ann") && !lists(ann, "bob"); }));
  EXPECT_EQ(server.inWorld(countShips), 1);
}

TEST(Company, LeavingOnPurposeRemovesTheShip) {
  TestServer server([](df::World& world) { populateBusyWorld(world, 10); });
  asio::io_context context;
  TestClient ann(context, server.port(), "ann");
  ASSERT_TRUE(serveUntil(context, {&ann}, [&] { return ann.joined(); }));
  ann.connection().leave();
  ASSERT_TRUE(serveUntil(context, {&ann}, [&] { return server.inWorld(countShips) == 0; }));
}

TEST(Company, StalledClientCostsTheOthersNothing) {
  TestServer server([](df::World& world) { populateBusyWorld(world, 300); });
  asio::io_context context;
  TestClient ann(context, server.port(), "ann");
  TestClient bob(context, server.port(), "bob");
  ASSERT_TRUE(serveUntil(context, {&ann, &bob}, [&] { return ann.joined() && bob.joined(); }));
  RawClient stalled(server.port());
  stalled.send(RawClient::hello("mud"));
  bob.keepPictures(false);

  // `mud` is not served: it neither reads nor acknowledges.
  const std::uint32_t begin = ann.newestTick();
  ASSERT_TRUE(serveUntil(context, {&ann, &bob}, [&] { return ann.newestTick() > begin + kFiveSeconds; }));
  // All that time the others had every tick, and the right picture.
  EXPECT_EQ(ann.session().state(), ClientSession::State::kPlaying);
  expectSame(ann, server, kFiveSeconds - 1);
}

TEST(Company, StalledClientCatchesUpWhenItReadsAgain) {
  TestServer server([](df::World& world) { populateBusyWorld(world, 300); });
  asio::io_context context;
  asio::io_context asleep;  // serving it or not is what stalls the second client
  TestClient ann(context, server.port(), "ann");
  TestClient mud(asleep, server.port(), "mud");
  ASSERT_TRUE(serveUntil(asleep, {&mud}, [&] { return mud.joined(); }));
  const std::uint32_t begin = mud.newestTick();
  ASSERT_TRUE(
      serveUntil(context, {&ann}, [&] { return ann.joined() && ann.newestTick() > begin + kFiveSeconds; }));
  const std::uint32_t stalled_until = ann.newestTick();
  // Once it reads again, it soon shows what the server has.
  EXPECT_TRUE(serveUntil(asleep, {&mud}, [&] {
    if (mud.newestTick() <= stalled_until + 50 || mud.pictures().empty()) return false;
    const auto& [tick, picture] = *mud.pictures().rbegin();
    const auto truth = server.truth(tick, mud.player());
    return tick > stalled_until && truth && countDifferences(picture, *truth) == 0;
  }));
}

TEST(Company, ChatReachesEveryoneCleaned) {
  TestServer server([](df::World& world) { populateBusyWorld(world, 5); });
  asio::io_context context;
  TestClient ann(context, server.port(), "ann");
  TestClient bob(context, server.port(), "bob");
  ASSERT_TRUE(serveUntil(context, {&ann, &bob}, [&] { return lists(ann, "bob") && lists(bob, "ann"); }));
  ann.session().sendChat("hi \x1b[2Jthere");
  ASSERT_TRUE(serveUntil(context, {&ann, &bob},
                         [&] { return !bob.session().chat().empty() && !ann.session().chat().empty(); }));
  EXPECT_EQ(bob.session().chat().back().name, "ann");
  EXPECT_EQ(bob.session().chat().back().text, "hi ?[2Jthere");
}

TEST(Company, SecondPlayerOfANameGetsANumber) {
  TestServer server([](df::World& world) { populateBusyWorld(world, 5); });
  asio::io_context context;
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

TEST(Company, RefusalsAreSentencesAPersonUnderstands) {
  HostOptions options = fastOptions();
  options.max_players = 1;
  TestServer server([](df::World& world) { populateBusyWorld(world, 5); }, options);

  wire::ClientMessage hello = RawClient::hello("old");
  hello.mutable_hello()->set_protocol(kProtocolVersion - 1);
  EXPECT_EQ(refusalOf(server.port(), hello).reason(), Reason::VERSION);
  EXPECT_NE(refusalOf(server.port(), hello).sentence().find("update the client"), std::string::npos);
  hello.mutable_hello()->set_protocol(kProtocolVersion + 1);
  EXPECT_NE(refusalOf(server.port(), hello).sentence().find("update the server"), std::string::npos);

  hello = RawClient::hello("lost");
  hello.mutable_hello()->set_game("chess");
  EXPECT_EQ(refusalOf(server.port(), hello).sentence(), "This server plays \"test\", not \"chess\".");
  EXPECT_EQ(refusalOf(server.port(), RawClient::hello("\x1b\n ")).reason(), Reason::NAME);

  asio::io_context context;
  TestClient ann(context, server.port(), "ann");
  ASSERT_TRUE(serveUntil(context, {&ann}, [&] { return ann.joined(); }));
  EXPECT_EQ(refusalOf(server.port(), RawClient::hello("late")).reason(), Reason::FULL);
}

TEST(Company, PlayersGetAGoodbyeWhenTheServerEnds) {
  TestServer server([](df::World& world) { populateBusyWorld(world, 5); });
  asio::io_context context;
  TestClient ann(context, server.port(), "ann");
  ASSERT_TRUE(serveUntil(context, {&ann}, [&] { return ann.joined(); }));
  std::thread stopper([&server] { server.stop("Closing time."); });
  EXPECT_TRUE(serveUntil(context, {&ann}, [&] { return ann.connection().isOver(); }));
  stopper.join();
  EXPECT_EQ(ann.connection().state(), Connection::State::kEnded);
  EXPECT_EQ(ann.connection().sentence(), "Closing time.");
}

}  // namespace
}  // namespace naiad::test
