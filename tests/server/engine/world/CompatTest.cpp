// Differences between the published engine and the book, and the compat setting that selects the former.
#include <stdlib.h>

#include <optional>

#include "engine/events/EventStep.h"
#include "engine/managers/LogManager.h"
#include "engine/world/Runner.h"
#include "tests/server/engine/Probe.h"

namespace df::test {
namespace {

/// Restores the environment after the test.
class CompatTest : public WorldTest {
 protected:
  CompatTest() { unsetenv("DF_COMPAT"); }
  ~CompatTest() override { unsetenv("DF_COMPAT"); }

  /// Returns the position of a Probe when it leaves the world of 80 by 24 cells (out event); nullopt if it
  /// gets no out event within 40 updates.
  std::optional<Vector> leavesAt(Vector from, Vector velocity, std::optional<Box> box = {}) {
    auto* p = new Probe("leaver", nullptr, from);
    if (box) p->setBox(*box);
    p->setVelocity(velocity);
    std::optional<Vector> at;
    int times = 0;
    p->on_event = [&](Probe& self, const Event& e) {
      if (e.getType() != OUT_EVENT) return;
      if (times++ == 0) at = self.getPosition();
    };
    for (int i = 0; i < 40; ++i) world.update();
    EXPECT_LE(times, 1);
    WM.markForDelete(p);
    world.update();
    return at;
  }
};

TEST_F(CompatTest, CompatCountsStepsFromZero) {
  std::vector<int> counts;
  Probe probe;
  probe.hear(STEP_EVENT, [&](Probe&, const Event& e) {
    if (const auto* p_step = dynamic_cast<const EventStep*>(&e)) counts.push_back(p_step->getStepCount());
  });
  world.setCompat();
  ticks(2);
  EXPECT_EQ(counts, (std::vector<int>{0, 1}));
  world.setCompat(false);
  world.tick();
  EXPECT_EQ(counts.back(), 3);
}

TEST_F(CompatTest, CompatJudgesLeavingByBoxNotPosition) {
  const Box sprite(Vector(-3, -1), 6, 2), beside(Vector(10, 0), 1, 1);
  const struct {
    const char* p_name;
    bool is_compat;
    Vector from, velocity;
    std::optional<Box> box;
    std::optional<Vector> at;
  } kCases[] = {
      {"by the book, right", false, Vector(78, 10), Vector(0.5, 0), {}, Vector(80, 10)},
      {"by the book, left", false, Vector(1, 10), Vector(-0.5, 0), {}, Vector(-0.5, 10)},
      {"by the book, large", false, Vector(78, 10), Vector(0.5, 0), sprite, Vector(80, 10)},
      {"right: at 80.5 it touches the edge", true, Vector(78, 10), Vector(0.5, 0), {}, Vector(81, 10)},
      {"left: 0.99 cells wide, from -0.5", true, Vector(1, 10), Vector(-0.25, 0), {}, Vector(-0.5, 10)},
      {"down", true, Vector(40, 20), Vector(0, 1), {}, Vector(40, 25)},
      {"large", true, Vector(78, 10), Vector(0.5, 0), sprite, Vector(83.5, 10)},
      {"beside its position", true, Vector(60, 10), Vector(0.5, 0), beside, Vector(70.5, 10)},
      {"after that one, by its own box", true, Vector(78, 10), Vector(0.5, 0), {}, Vector(81, 10)},
      {"placed outside", true, Vector(82, 10), Vector(1, 0), {}, {}},
      {"placed outside, then in", true, Vector(85, 10), Vector(-2.5, 0), {}, Vector(-2.5, 10)},
  };
  for (const auto& its : kCases) {
    world.setCompat(its.is_compat);
    EXPECT_EQ(leavesAt(its.from, its.velocity, its.box), its.at) << its.p_name;
  }
}

TEST_F(CompatTest, SpritelessNeighboursDoNotTouchInCompat) {
  world.setCompat();
  Probe a("a", &received, Vector(10, 10));
  Probe b("b", &received, Vector(12, 10));
  EXPECT_EQ(WM.moveObject(&a, Vector(11, 10)), 0);
  EXPECT_TRUE(received.empty());
  EXPECT_EQ(a.getBox().getCorner(), Vector(-0.5, -0.5));
  EXPECT_FLOAT_EQ(a.getBox().getHorizontal(), 0.99F);
  EXPECT_FLOAT_EQ(a.getBox().getVertical(), 0.99F);
  world.setCompat(false);
  Probe c("c", &received, Vector(13, 12));
  Probe d("d", &received, Vector(15, 12));
  EXPECT_EQ(WM.moveObject(&c, Vector(14, 12)), -1);
}

TEST_F(CompatTest, CompatReversesLogLevels) {
  LM.setLogLevel(3);
  LM.writeLog(5, "five");
  LM.writeLog(1, "one");
  EXPECT_EQ(logged("five"), 0);
  EXPECT_EQ(logged("one"), 1);
  world.setCompat();
  LM.writeLog(5, "five");
  LM.writeLog(1, "one");
  EXPECT_EQ(logged("five"), 1);
  EXPECT_EQ(logged("one"), 1);
}

TEST_F(CompatTest, EnvironmentOverridesCompatMode) {
  EXPECT_EQ(world.program(), nullptr);
  GM.startUp();
  EXPECT_FALSE(world.compat());
  setenv("DF_COMPAT", "1", 1);
  GM.startUp();
  EXPECT_TRUE(world.compat());
  setenv("DF_COMPAT", "0", 1);
  GM.startUp();
  EXPECT_FALSE(world.compat());
  setenv("DF_COMPAT", "perhaps", 1);
  world.setCompat();
  GM.startUp();
  EXPECT_TRUE(world.compat());
}

TEST_F(WorldTest, GameOverForOnePlayerLeavesOthersPlaying) {
  Probe quitter("quitter");
  quitter.hear(KEYBOARD_EVENT, [](Probe&, const Event& e) {
    if (e.getType() == KEYBOARD_EVENT) GM.setGameOver();
  });
  world.input().setGameOverLeaves(true);
  const std::uint32_t ann = world.input().join("ann", CYAN);
  const std::uint32_t bob = world.input().join("bob", RED);
  pressedBy({bob}, Keyboard::Q);
  EXPECT_FALSE(world.isGameOver());
  EXPECT_EQ(world.input().popLeavers(), std::vector<std::uint32_t>{bob});
  EXPECT_TRUE(world.input().popLeavers().empty());
  GM.setGameOver();  // outside any player's input
  EXPECT_TRUE(world.isGameOver());
  GM.setGameOver(false);
  world.input().setGameOverLeaves(false);
  pressedBy({ann}, Keyboard::Q);
  EXPECT_TRUE(world.isGameOver());
}

}  // namespace
}  // namespace df::test
