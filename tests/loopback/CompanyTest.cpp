// Players of one server affect each other only as intended: killed and stalled clients, chat.
#include <gtest/gtest.h>

#include "Compare.h"
#include "LoopbackFixture.h"
#include "RawClient.h"
#include "engine/world/ObjectRegistry.h"
#include "engine/world/Player.h"

namespace naiad::test {
namespace {

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

}  // namespace
}  // namespace naiad::test
