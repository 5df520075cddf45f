#include "engine/events/EventStep.h"
#include "engine/managers/DisplayManager.h"
#include "engine/managers/InputManager.h"
#include "engine/managers/LogManager.h"
#include "engine/published/utility.h"
#include "engine/world/Random.h"
#include "tests/server/engine/Probe.h"

namespace df::test {
namespace {

class WorldLife : public WorldTest {};

TEST_F(WorldLife, TwoWorldsInOneProcessDoNotInteract) {
  Probe here("here", nullptr, Vector(10, 10));
  World other;
  {
    const World::Scope scope_of_other(other);
    EXPECT_EQ(&World::current(), &other);
    auto* p_there = new Probe("there", nullptr, Vector(10, 10));
    p_there->setVelocity(Vector(1, 0));
    EXPECT_EQ(WM.getAllObjects().getCount(), 1);
    EXPECT_EQ(WM.markForDelete(&here), -1);
    EXPECT_EQ(WM.removeObject(&here), -1);
    EXPECT_EQ(WM.insertObject(&here), -1);
    EXPECT_EQ(WM.moveObject(&here, Vector(0, 0)), -1);
    EXPECT_TRUE(WM.getCollisions(&here, Vector(10, 10)).isEmpty());
  }
  EXPECT_EQ(&World::current(), &world);
  EXPECT_EQ(WM.getAllObjects().getCount(), 1);
  other.update();  // `other` is not current here, but it is for its handlers
  EXPECT_EQ(other.objects().objectsOfType("there")[0]->getPosition(), Vector(11, 10));
  other.shutDown();
}

TEST_F(WorldLife, HandlersSeeTheirOwnWorldAsCurrent) {
  World other;
  World* p_seen = nullptr;
  {
    const World::Scope scope_of_other(other);
    auto* p = new Probe("there");
    p->hear(STEP_EVENT, [&](Probe&, const Event&) { p_seen = &World::current(); });
  }
  other.tick();
  EXPECT_EQ(p_seen, &other);
  other.shutDown();
}

TEST_F(WorldLife, ShutDownDeletesHeapObjectsAndResetsState) {
  EXPECT_EQ(GM.startUp(), 0);
  EXPECT_TRUE(GM.isStarted() && WM.isStarted() && LM.isStarted() && DM.isStarted() && IM.isStarted());
  int dead = 0;
  struct Counted : Object {
    explicit Counted(int* p) : p_dead(p) {}
    ~Counted() override { ++*p_dead; }
    int* p_dead;
  };
  new Counted(&dead);
  Counted automatic(&dead);
  WM.setBoundary(Box(Vector(0, 0), 200, 200));
  DM.setSize(100, 30);
  world.input().join("ann", RED);
  GM.tick();
  GM.setGameOver();
  GM.shutDown();
  EXPECT_EQ(dead, 1);
  EXPECT_EQ(world.store().countInWorld(), 0);
  EXPECT_FALSE(GM.isStarted());
  EXPECT_FALSE(GM.getGameOver());
  EXPECT_EQ(GM.getStepCount(), 0);
  EXPECT_TRUE(WM.getPlayers().empty());
  EXPECT_EQ(WM.getBoundary(), Box(Vector(0, 0), 80, 24));
  EXPECT_EQ(GM.startUp(), 0);
  new Counted(&dead);
  GM.tick();
  EXPECT_EQ(world.store().countInWorld(), 1);
  GM.shutDown();
  EXPECT_EQ(dead, 2);
}

TEST_F(WorldLife, ObjectsMadeInDestructorsAreDeletedToo) {
  struct Phoenix : Object {
    explicit Phoenix(int lives) : left(lives) {}
    ~Phoenix() override {
      if (left > 0) new Phoenix(left - 1);
    }
    int left;
  };
  new Phoenix(5);
  WM.shutDown();
  EXPECT_EQ(world.store().countInWorld(), 0);
}

TEST_F(WorldLife, ShutDownInsideATickWaitsForItsEnd) {
  auto* p = new Probe("quitter");
  bool alive_after = false;
  p->hear(STEP_EVENT, [&](Probe& self, const Event&) {
    GM.shutDown();
    alive_after = self.getType() == "quitter";
  });
  GM.run();
  EXPECT_TRUE(alive_after);
  EXPECT_TRUE(GM.getGameOver());
  EXPECT_EQ(world.store().countInWorld(), 0);
  GM.startUp();
  EXPECT_FALSE(GM.getGameOver());
}

TEST_F(WorldLife, ShutDownOutsideATickWaitsForTheHandler) {
  auto* p_quitter = new Probe("quitter", nullptr, Vector(10, 10));
  auto* p_wall = new Probe("wall", nullptr, Vector(20, 20));
  bool alive_after = false;
  p_quitter->on_event = [&](Probe& self, const Event&) {
    GM.shutDown();
    alive_after = world.store().countInWorld() == 2 && self.getType() == "quitter";
  };
  const Vector there = p_wall->getPosition();
  EXPECT_EQ(WM.moveObject(p_quitter, there), -1);
  EXPECT_TRUE(alive_after);
  EXPECT_TRUE(GM.getGameOver());
  EXPECT_EQ(world.store().countInWorld(), 0);
  Probe next("next", &received);
  next.registerInterest(KEYBOARD_EVENT);
  press(Keyboard::A);
  EXPECT_EQ(world.store().countInWorld(), 1) << "it is shut down once";
}

TEST_F(WorldLife, RunCanBeCalledAgainAfterGameOver) {
  GM.startUp();
  Probe p("title");
  int handled = 0;
  p.hear(STEP_EVENT, [&](Probe&, const Event&) {
    if (++handled % 3 == 0) GM.setGameOver();
  });
  GM.run();
  EXPECT_EQ(handled, 3);
  EXPECT_TRUE(GM.getGameOver());
  GM.run();
  EXPECT_EQ(handled, 6);
  EXPECT_TRUE(GM.getGameOver());
}

TEST_F(WorldLife, RandomNumbersFollowTheSeed) {
  GM.setSeed(42);
  std::vector<int> first;
  for (int i = 0; i < 100; ++i) first.push_back(WM.randomInt(1000));
  GM.setSeed(42);
  for (const int n : first) EXPECT_EQ(WM.randomInt(1000), n);
  GM.setSeed(43);
  int same = 0;
  for (const int n : first) same += WM.randomInt(1000) == n ? 1 : 0;
  EXPECT_LT(same, 10);
  EXPECT_EQ(WM.randomInt(1), 0);
  EXPECT_EQ(WM.randomInt(0), 0);
  EXPECT_EQ(WM.randomInt(-3), 0);
  std::vector<int> counts(6);
  for (int i = 0; i < 6000; ++i) ++counts[WM.randomInt(6)];
  for (const int count : counts) EXPECT_NEAR(count, 1000, 150);
}

TEST(RandomSequence, MatchesTheXoshiroReferenceValue) {
  Random random(0);
  EXPECT_EQ(random.next(), 0x99EC5F36CB75F2B4u);  // xoshiro256** after splitmix64(0)
}

TEST_F(WorldLife, LogLinesGoToTheSinkByLevel) {
  EXPECT_EQ(LM.writeLog("score %d\n", 7), 8);
  EXPECT_EQ(LM.writeLog(0, "shown"), 5);
  EXPECT_EQ(LM.writeLog(2, "hidden"), 0);
  LM.setLogLevel(2);
  LM.writeLog(2, "now %s", "shown");
  EXPECT_EQ(lines, (std::vector<std::string>{"score 7", "shown", "now shown"}));
}

TEST_F(WorldLife, AGameMayAddAManager) {
  struct Music : Manager {
    Music() { setType("Music"); }
  } music;
  EXPECT_FALSE(music.isStarted());
  EXPECT_EQ(music.startUp(), 0);
  EXPECT_TRUE(music.isStarted());
  EXPECT_EQ(music.getType(), "Music");
  Probe p("p", &received);
  p.registerInterest("song");
  Event song;
  song.setType("song");
  EXPECT_EQ(music.onEvent(&song), 1);
  music.shutDown();
  EXPECT_FALSE(music.isStarted());
}

TEST_F(WorldLife, UtilityFunctionsMatchTheBook) {
  EXPECT_TRUE(positionsIntersect(Vector(1, 1), Vector(2, 0)));
  EXPECT_FALSE(positionsIntersect(Vector(1, 1), Vector(2.001, 1)));
  EXPECT_TRUE(boxIntersectsBox(Box(Vector(0, 0), 1, 1), Box(Vector(1, 1), 1, 1)));
  EXPECT_FALSE(boxIntersectsBox(Box(Vector(0, 0), 1, 1), Box(Vector(1.01, 1), 1, 1)));
  EXPECT_TRUE(boxContainsPosition(Box(Vector(0, 0), 2, 2), Vector(2, 0)));
  EXPECT_FALSE(boxContainsPosition(Box(Vector(0, 0), 2, 2), Vector(2.1, 0)));
  EXPECT_EQ(distance(Vector(0, 0), Vector(3, 4)), 5);
  PlacedObject o(Vector(10, 5));
  EXPECT_EQ(getWorldBox(&o), Box(Vector(9.5, 4.5), 1, 1));
  EXPECT_EQ(getWorldBox(&o, Vector(1, 1)), Box(Vector(0.5, 0.5), 1, 1));
  WM.setBoundary(Box(Vector(0, 0), 300, 300));
  WM.setView(Box(Vector(20, 30), 80, 24));
  EXPECT_EQ(worldToView(Vector(25, 31)), Vector(5, 1));
  EXPECT_EQ(viewToWorld(Vector(5, 1)), Vector(25, 31));
}

}  // namespace
}  // namespace df::test
