#include <gtest/gtest.h>

#include <stdexcept>

#include "engine/events/EventKeyboard.h"
#include "engine/events/EventMouse.h"
#include "engine/managers/DisplayManager.h"
#include "engine/managers/GameManager.h"
#include "engine/managers/WorldManager.h"
#include "engine/testing/GameTest.h"
#include "engine/widgets/PlayerObject.h"

namespace df::test {
namespace {

int g_runs_ended = 0;
int g_mains_ended = 0;

/// An @ that moves with an arrow key or a click, shows the number of keys, and ends the game with Q.
class Walker : public PlayerObject<> {
 public:
  explicit Walker(Player& player) : PlayerObject(player) {
    setType("Walker");
    setPosition(Vector(10 + WM.randomInt(40), 5));
  }
  int held = 0;
  int draw() override { return DM.drawCh(getPosition(), '@', getColor()); }

 private:
  void keyboard(const EventKeyboard& event) override {
    if (event.getKeyboardAction() == KEY_DOWN) ++held;
    if (event.getKeyboardAction() != KEY_PRESSED) return;
    if (event.getKey() == Keyboard::RIGHTARROW) WM.moveObject(this, getPosition() + Vector(1, 0));
    if (event.getKey() == Keyboard::Q) GM.setGameOver();
    getPlayer()->setScore(getPlayer()->getScore() + 1);
    getPlayer()->setText(0, Vector(0, 0), "keys " + std::to_string(getPlayer()->getScore()));
  }
  void mouse(const EventMouse& event) override { setPosition(event.getMousePosition()); }
};

template <int kRuns>
int mainWithRuns() {
  GM.startUp();
  new JoinSpawner<Walker>;
  for (int run = 0; run < kRuns; ++run) {
    GM.run();
    ++g_runs_ended;
  }
  GM.shutDown();
  ++g_mains_ended;
  return 0;
}
constexpr auto walkerMain = mainWithRuns<1>;

int noRunMain() {
  return GM.startUp();
}

int throwingMain() {
  throw std::runtime_error("no level");
}

TEST(GameTest, KeysReachTheGameAndChangeItsPicture) {
  GameTest game(walkerMain, 7);
  const std::uint32_t ann = game.join("ann");
  EXPECT_EQ(game.count("@"), 1);
  const float before = game.find("Walker")->getPosition().getX();
  game.press(Keyboard::RIGHTARROW);
  EXPECT_EQ(game.find("Walker")->getPosition().getX(), before + 1);
  EXPECT_EQ(game.at(static_cast<int>(before) + 1, 5), U'@');
  EXPECT_EQ(game.colorAt(static_cast<int>(before) + 1, 5), RED);
  EXPECT_TRUE(game.shows("keys 1", ann));
  EXPECT_EQ(game.score(), 1);
  EXPECT_EQ(game.getTicks(), 2);
}

TEST(GameTest, HoldKeepsAKeyDownForGivenTicks) {
  GameTest game(walkerMain);
  game.join();
  game.hold(Keyboard::A, 5);
  EXPECT_EQ(game.getTicks(), 6);
  EXPECT_EQ(dynamic_cast<Walker*>(game.find("Walker"))->held, 4);
}

TEST(GameTest, PlayersHaveSeparateKeysAndViews) {
  GameTest game(walkerMain);
  game.join("ann");
  const std::uint32_t bob = game.join("bob");
  game.down(Keyboard::A, bob);
  game.tick();
  EXPECT_EQ(game.score(bob), 1);
  EXPECT_EQ(game.score(), 0);
  EXPECT_TRUE(game.shows("keys 1", bob));
  EXPECT_FALSE(game.shows("keys"));
  game.leave(bob);
  game.tick();
  EXPECT_EQ(game.objects("Walker"), 1);
}

TEST(GameTest, ClicksUseViewCells) {
  GameTest game(walkerMain);
  game.join();
  game.click(33, 9);
  EXPECT_EQ(game.at(33, 9), U'@');
}

TEST(GameTest, TheSameSeedGivesTheSameGame) {
  std::string first;
  {
    GameTest game(walkerMain, 3);
    game.join();
    first = game.picture();
  }
  GameTest again(walkerMain, 3);
  again.join();
  EXPECT_EQ(again.picture(), first);
  GameTest other(walkerMain, 4);
  other.join();
  EXPECT_NE(other.picture(), first);
}

TEST(GameTest, NoTickRunsAfterGameOver) {
  GameTest game(walkerMain);
  game.join();
  game.press(Keyboard::Q);
  EXPECT_TRUE(game.isOver());
  EXPECT_EQ(game.tick(10), 0);
}

TEST(GameTest, GameThatRunsTwiceContinues) {
  g_runs_ended = 0;
  GameTest game(mainWithRuns<2>);
  game.join();
  game.press(Keyboard::Q);
  EXPECT_EQ(g_runs_ended, 1);
  EXPECT_FALSE(game.isOver());
  EXPECT_EQ(game.tick(3), 3);
  game.press(Keyboard::Q);
  EXPECT_EQ(g_runs_ended, 2);
  EXPECT_TRUE(game.isOver());
}

TEST(GameTest, MainRunsToItsEnd) {
  g_mains_ended = 0;
  const int before = WM.getAllObjects(true).getCount();  // static Objects of other tests
  { GameTest game(walkerMain); }
  EXPECT_EQ(g_mains_ended, 1);
  EXPECT_EQ(WM.getAllObjects(true).getCount(), before);
}

TEST(GameTest, TickUntilStopsWhenTheConditionHolds) {
  GameTest game(walkerMain);
  EXPECT_TRUE(game.tickUntil([&] { return game.getTicks() == 12; }));
  EXPECT_FALSE(game.tickUntil([] { return false; }, 5));
  EXPECT_EQ(game.getTicks(), 17);
}

TEST(GameTest, MainWithoutRunThrowsAClearError) {
  const auto errorOf = [](int (*main)()) -> std::string {
    try {
      GameTest game(main);
      return "none";
    } catch (const std::runtime_error& error) {
      return error.what();
    }
  };
  EXPECT_EQ(errorOf(noRunMain), "The game's main() ended without having called GM.run().");
  EXPECT_EQ(errorOf(throwingMain), "The game's main() threw before GM.run(): no level");
  EXPECT_THROW(GameTest("/no/such/game.so"), std::runtime_error);
}

TEST(GameTest, FailedCheckPrintsThePicture) {
  GameTest game(walkerMain);
  game.join();
  testing::internal::CaptureStderr();
  EXPECT_FALSE(game.expect(false, "the moon is green"));
  const std::string said = testing::internal::GetCapturedStderr();
  EXPECT_NE(said.find("GameTestTest.cpp:"), std::string::npos);
  EXPECT_NE(said.find("check failed: the moon is green\nThe picture after tick 1:\n"), std::string::npos);
  EXPECT_NE(said.find('@'), std::string::npos);
  EXPECT_EQ(GameTest::report(), 1);
}

int g_exits = 0;

int exitingMain() {
  GM.startUp();
  ++g_exits;
  std::exit(0);
}

TEST(GameTestDeathTest, GameCallingExitFailsItsTest) {
  testing::FLAGS_gtest_death_test_style = "threadsafe";
  EXPECT_EXIT(GameTest game(exitingMain), testing::ExitedWithCode(1), "the game called exit");
}

}  // namespace
}  // namespace df::test
