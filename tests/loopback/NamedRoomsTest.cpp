// Rooms of one server (--room), each with a game in its own process (rooms/game.cpp): joining by name, moving
// between rooms, sleep, and isolation from another room's failure. Real processes and sockets.
#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <fstream>

#include "RoomsFixture.h"

namespace naiad::test {
namespace {

class NamedRooms : public RoomsFixture {};

TEST_F(NamedRooms, PlayersOfTwoRoomsPlayInTwoWorlds) {
  start({"one", "two"});
  auto ann = join("ann", "");
  auto bob = join("bob", "two");
  auto cid = join("cid", "one");
  EXPECT_EQ(ann->session().welcome().room, "one") << "players begin in the first";
  EXPECT_EQ(bob->session().welcome().room, "two");
  EXPECT_EQ(bob->session().welcome().game, "room_module");
  press(*bob, df::Keyboard::X);
  ASSERT_TRUE(serve([&] { return shown(*bob).keys == 1; }));
  EXPECT_EQ(shown(*ann).keys, 0);
  EXPECT_EQ(shown(*ann).process, shown(*cid).process);
  EXPECT_NE(shown(*ann).process, shown(*bob).process);
  ann->session().sendChat("hello");
  EXPECT_TRUE(serve([&] { return hasRead(*bob, "hello"); })) << "chat is everybody's";
}

TEST_F(NamedRooms, PlayerMovesInTheSameSession) {
  start({"one", "two"});
  auto ann = join("ann", "one");
  auto bob = join("bob", "two");
  const ClientSession* const p_session = &ann->session();
  const int process = shown(*bob).process;
  const std::uint32_t player = ann->player();
  press(*ann, df::Keyboard::X);
  ASSERT_TRUE(serve([&] { return shown(*ann).keys == 1; }));
  ann->session().enterRoom("two");
  const auto took =
      timeUntil(context, {ann.get(), bob.get()}, [&] { return shown(*ann).process == process; });
  ASSERT_TRUE(took) << game->log();
  EXPECT_LE(*took, std::chrono::milliseconds(300));
  EXPECT_EQ(&ann->session(), p_session);
  EXPECT_EQ(ann->session().welcome().room, "two");
  EXPECT_NE(ann->player(), player) << "an id is used once in a world";
  EXPECT_TRUE(hasRead(*ann, "You are now in room two"));
  press(*ann, df::Keyboard::X);
  EXPECT_TRUE(serve([&] { return shown(*ann).keys == 1 && shown(*bob).keys == 1; })) << "keys go there, too";
  ann->session().enterRoom("one");
  EXPECT_TRUE(serve([&] { return shown(*ann).process != process && shown(*ann).process > 0; }));
  EXPECT_EQ(ann->session().counters().bad_messages, 0u);
}

// A world that has missed ticks has a lower tick number than the others.
TEST_F(NamedRooms, PlayerMovesToAWorldWithEarlierTicks) {
  start({"one", "slow"});
  auto ann = join("ann", "one");
  auto bob = join("bob", "slow");
  const int slow = shown(*bob).process;
  press(*bob, df::Keyboard::S);
  ASSERT_TRUE(serve([&] { return shown(*ann).ticks > shown(*bob).ticks + 200; }));
  ann->session().enterRoom("slow");
  ASSERT_TRUE(serve([&] { return shown(*ann).process == slow; }));
  const int ticks = shown(*ann).ticks;
  EXPECT_TRUE(serve([&] { return shown(*ann).ticks > ticks; })) << "the picture goes on";
  EXPECT_LT(ann->newestTick(), bob->newestTick() + 100);
}

TEST_F(NamedRooms, RoomSleepsWithoutPlayersAndWakes) {
  start({"one", "two"}, {"--room-sleep=0.2"});
  auto ann = join("ann", "one");
  ASSERT_TRUE(serve([&] { return roomInList(*ann, "two") != nullptr; }));
  EXPECT_TRUE(roomInList(*ann, "two")->asleep) << "it has had no players yet";
  auto bob = join("bob", "two");
  const int process = shown(*bob).process;
  ASSERT_TRUE(serve([&] { return !roomInList(*ann, "two")->asleep; }));
  EXPECT_EQ(roomInList(*ann, "two")->players, 1u);
  bob->session().enterRoom("one");
  ASSERT_TRUE(serve([&] { return roomInList(*ann, "two")->asleep; }));
  EXPECT_TRUE(serve([&] { return kill(process, 0) != 0; })) << "its process has ended";
  ann->session().enterRoom("two");
  EXPECT_TRUE(serve([&] {
    return shown(*ann).process > 0 && shown(*ann).process != process &&
           ann->session().welcome().room == "two" && shown(*ann).keys == 0;
  }));
  EXPECT_FALSE(has(game->log(), "crashed"));
}

/// The game of one room does not affect players in another: their ticks continue.
class Isolation : public RoomsFixture {
 protected:
  /// Presses `key` in the room "bad" and waits until `done` returns true.
  void expectOthersGoOn(df::Keyboard::Key key, const std::function<bool(TestClient& bad)>& done) {
    start({"good", "bad", "other"});
    auto ann = join("ann", "good");
    auto bob = join("bob", "bad");
    auto cid = join("cid", "other");
    const int first = shown(*ann).ticks;
    const int other = shown(*cid).ticks;
    const int process = shown(*ann).process;
    const auto began = Clock::now();
    press(*bob, key);
    ASSERT_TRUE(serve([&] { return done(*bob); })) << game->log();
    const auto passed = std::chrono::duration<double>(Clock::now() - began).count();
    // 15 % of the ticks are enough, because the machine may be busy. A world that waited for the bad one
    // would have had almost none.
    const int least = static_cast<int>(passed / 0.005 * 0.15);
    EXPECT_GE(shown(*ann).ticks - first, least) << passed;
    EXPECT_GE(shown(*cid).ticks - other, least) << passed;
    EXPECT_EQ(shown(*ann).process, process);
    EXPECT_TRUE(bob->joined()) << "and they may be in the next round of theirs";
  }
};

TEST_F(Isolation, CrashAffectsOnlyItsRoom) {
  int process = 0;
  expectOthersGoOn(df::Keyboard::C, [&](TestClient& bad) {
    if (process == 0) process = shown(bad).process;
    return shown(bad).process != process && shown(bad).process > 0;
  });
  EXPECT_TRUE(waitForLog("in the room bad: the game crashed (SIGABRT)")) << game->log();
}

TEST_F(Isolation, HangAffectsOnlyItsRoom) {
  const auto began = Clock::now();
  expectOthersGoOn(df::Keyboard::H,
                   [&](TestClient&) { return Clock::now() - began > std::chrono::milliseconds(1500); });
}

TEST_F(Isolation, LoadAffectsOnlyItsRoom) {
  int ticks = -1;
  expectOthersGoOn(df::Keyboard::B, [&](TestClient& bad) {
    if (ticks < 0) ticks = shown(bad).ticks;
    return shown(bad).ticks > ticks + 2;  // each of these ticks takes a tenth of a second of processor time
  });
}

TEST_F(NamedRooms, RepeatedlyFailingGameClosesOnlyItsRoom) {
  start({"one", "two"}, {"--room-sleep=0"});
  auto ann = join("ann", "one");
  auto bob = join("bob", "two");
  std::ofstream(game->playFolder() / "fails") << "yes";
  press(*bob, df::Keyboard::C);
  ASSERT_TRUE(serve([&] { return bob->session().welcome().room == "one"; })) << game->log();
  EXPECT_TRUE(waitForLog("the room two is closed for 30 s")) << game->log();
  EXPECT_TRUE(serve([&] { return shown(*bob).process == shown(*ann).process; }));
  auto eve = connect("eve", "two");
  EXPECT_TRUE(serve([&] { return eve->connection().isDeferred(); })) << "it tries again";
  EXPECT_TRUE(has(eve->connection().message(), "closed for a moment"));
}

}  // namespace
}  // namespace naiad::test
