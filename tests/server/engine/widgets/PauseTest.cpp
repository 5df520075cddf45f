// The Pause object lets the players vote on pausing the game.

#include "engine/events/EventStep.h"
#include "engine/widgets/Pause.h"
#include "engine/world/EventPlayer.h"
#include "engine/world/WorldExtras.h"
#include "tests/server/engine/Probe.h"

namespace df::test {
namespace {

using Notes = std::vector<std::string>;

class PauseTest : public WorldTest {
 protected:
  PauseTest() {
    world.store().setWatched(true);
    new Pause(Keyboard::P);
  }
  void join(int count) {
    for (int i = 0; i < count; ++i) players.push_back(world.input().join("player", RED));
    world.tick();
  }
  /// Runs one tick in which these players (indices) press the key.
  void press(const std::vector<std::size_t>& voters) {
    for (const std::size_t i : voters) world.input().key(players[i], Keyboard::P, KEY_PRESSED);
    world.tick();
  }
  const Notes& notes() const { return world.picture().view().notes; }

  std::vector<std::uint32_t> players;
};

TEST_F(PauseTest, OnePlayerAloneDecides) {
  join(1);
  press({0});
  EXPECT_TRUE(world.isPaused());
  EXPECT_EQ(notes(), Notes{});
  press({0});
  EXPECT_FALSE(world.isPaused());
}

TEST_F(PauseTest, MajorityOfPlayersDecides) {
  join(3);
  press({0});
  EXPECT_FALSE(world.isPaused());
  EXPECT_EQ(notes(), Notes{"pause: 1 of 3"});
  world.tick();
  EXPECT_EQ(notes(), Notes{}) << "said once";
  press({2});
  EXPECT_TRUE(world.isPaused());
  EXPECT_EQ(notes(), Notes{"pause: 2 of 3"});
  press({1});
  EXPECT_TRUE(world.isPaused());
  EXPECT_EQ(notes(), Notes{"resume: 1 of 3"});
  press({0});
  EXPECT_FALSE(world.isPaused());
}

TEST_F(PauseTest, PressingTwiceIsOneVote) {
  join(3);
  press({1, 1, 1});
  press({1});
  EXPECT_FALSE(world.isPaused());
  EXPECT_EQ(notes(), Notes{}) << "so a player cannot fill the others' screens";
}

TEST_F(PauseTest, VotesExpireAfterTenSeconds) {
  join(2);
  press({0});
  for (int i = 0; i < 300; ++i) world.tick();
  press({1});
  EXPECT_FALSE(world.isPaused());
  EXPECT_EQ(notes(), Notes{"pause: 1 of 2"});
  for (int i = 0; i < 299; ++i) world.tick();
  press({0});
  EXPECT_TRUE(world.isPaused());
}

TEST_F(PauseTest, DepartedPlayersAreNotCounted) {
  join(4);
  press({0, 1});
  EXPECT_FALSE(world.isPaused()) << "two of four";
  left(players[3]);
  EXPECT_TRUE(world.isPaused()) << "two of three";
  EXPECT_EQ(notes(), Notes{"pause: 2 of 3"});
}

TEST_F(PauseTest, DepartedPlayersLoseTheirVote) {
  join(3);
  press({0});
  left(players[0]);
  press({1});
  EXPECT_FALSE(world.isPaused());
  EXPECT_EQ(notes(), Notes{"pause: 1 of 2"});
}

TEST_F(PauseTest, GameResumesWhenTheLastPlayerLeaves) {
  join(2);
  press({0, 1});
  ASSERT_TRUE(world.isPaused());
  left(players[0]);
  EXPECT_TRUE(world.isPaused()) << "one is there, and may want it";
  left(players[1]);
  EXPECT_FALSE(world.isPaused());
}

TEST_F(PauseTest, OnlyPlayersWithInputFocusCanVote) {
  join(3);
  world.extras().input_player = players[1];
  press({1});
  EXPECT_TRUE(world.isPaused());
  EXPECT_EQ(notes(), Notes{});
  world.extras().input_player = 0;
  press({1});
  EXPECT_TRUE(world.isPaused());
}

TEST_F(PauseTest, KeyEventSentByTheGamePauses) {
  join(3);
  WorldTest::press(Keyboard::P);
  EXPECT_TRUE(world.isPaused());
}

TEST_F(PauseTest, JoinAndLeaveEventsAreSentDuringPause) {
  join(1);
  press({0});
  Probe game("game", &received);
  for (const std::string& type : {std::string(JOIN_EVENT), std::string(LEAVE_EVENT), std::string(STEP_EVENT)})
    game.registerInterest(type);
  join(1);
  left(players[1]);
  EXPECT_TRUE(world.isPaused());
  EXPECT_EQ(received, (Received{"game:df-join", "game:df-leave"}));
  const EventStep step;
  EXPECT_EQ(WM.onEvent(&step), 0);
  EXPECT_EQ(world.events().sendToAll(step), 1) << "as the events of the network are";
}

}  // namespace
}  // namespace df::test
