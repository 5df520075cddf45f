#include <sstream>

#include "engine/managers/Clock.h"
#include "engine/published/NetworkNode.h"
#include "engine/published/StateMachine.h"
#include "engine/published/utility.h"
#include "engine/world/WorldExtras.h"
#include "tests/server/engine/Probe.h"

namespace df::test {
namespace {

using UtilityTest = WorldTest;

TEST_F(UtilityTest, BoxContainsBoxesUpToItsEdges) {
  const Box box(Vector(1, 1), 4, 2);
  EXPECT_TRUE(boxContainsBox(box, Box(Vector(1, 1), 4, 2)));
  EXPECT_TRUE(boxContainsBox(box, Box(Vector(2, 2), 1, 1)));
  EXPECT_FALSE(boxContainsBox(box, Box(Vector(2, 2), 4, 1)));
  EXPECT_FALSE(boxContainsBox(Box(Vector(2, 2), 1, 1), box));
  EXPECT_TRUE(valueInRange(1, 1, 2));
  EXPECT_FALSE(valueInRange(2.5, 1, 2));
}

TEST_F(UtilityTest, LinesCross) {
  const Line rising(Vector(0, 0), Vector(4, 4));
  EXPECT_TRUE(lineIntersectsLine(rising, Line(Vector(0, 4), Vector(4, 0))));
  EXPECT_TRUE(lineIntersectsLine(rising, Line(Vector(4, 4), Vector(9, 0))));  // at the end point
  EXPECT_FALSE(lineIntersectsLine(rising, Line(Vector(5, 4), Vector(9, 0))));
  EXPECT_FALSE(lineIntersectsLine(rising, Line(Vector(1, 0), Vector(5, 4))));  // parallel
  EXPECT_FALSE(lineIntersectsLine(rising, rising));
}

TEST_F(UtilityTest, LinesIntersectBoxes) {
  const Box box(Vector(2, 2), 2, 2);
  EXPECT_TRUE(lineIntersectsBox(Line(Vector(0, 3), Vector(9, 3)), box));    // through
  EXPECT_TRUE(lineIntersectsBox(Line(Vector(3, 3), Vector(3.5, 3)), box));  // inside
  EXPECT_TRUE(lineIntersectsBox(Line(Vector(0, 2), Vector(9, 2)), box));    // along the edge
  EXPECT_TRUE(lineIntersectsBox(Line(Vector(0, 4), Vector(4, 0)), box));    // touches the corner
  EXPECT_FALSE(lineIntersectsBox(Line(Vector(0, 3.9), Vector(3.9, 0)), box));
  EXPECT_FALSE(lineIntersectsBox(Line(Vector(0, 3), Vector(1.5, 3)), box));  // too short
  EXPECT_FALSE(lineIntersectsBox(Line(Vector(5, 0), Vector(5, 9)), box));
}

TEST_F(UtilityTest, CirclesIntersectBoxes) {
  const Box box(Vector(2, 2), 2, 2);
  EXPECT_TRUE(circleIntersectsBox(Circle(Vector(3, 3), 0.1f), box));
  EXPECT_TRUE(circleIntersectsBox(Circle(Vector(6, 3), 2), box));
  EXPECT_FALSE(circleIntersectsBox(Circle(Vector(6, 3), 1.9f), box));
  EXPECT_FALSE(circleIntersectsBox(Circle(Vector(5, 5), 1.4f), box));
}

TEST_F(UtilityTest, ObjectsAreFoundByArea) {
  PlacedObject a(Vector(10, 10));
  PlacedObject b(Vector(20, 10));
  PlacedObject asleep(Vector(10, 10));
  asleep.setActive(false);
  const auto first = [](const ObjectList& list) { return list.getCount() == 1 ? list[0] : nullptr; };
  EXPECT_EQ(first(WM.objectsAtPosition(Vector(10.5, 10))), &a);
  EXPECT_EQ(first(WM.objectsInBox(Box(Vector(18, 8), 4, 4))), &b);
  EXPECT_EQ(first(WM.objectsInCircle(Circle(Vector(13, 10), 3))), &a);
  EXPECT_EQ(WM.objectsOnLine(Line(Vector(0, 10), Vector(79, 10))).getCount(), 2);
  EXPECT_EQ(WM.getSceneGraph().activeObjects().getCount(), 2);
  EXPECT_EQ(first(WM.getSceneGraph().inactiveObjects()), &asleep);
  EXPECT_EQ(WM.getSceneGraph().visibleObjects(2).getCount(), 2);
  EXPECT_EQ(WM.getSceneGraph().visibleObjects(3).getCount(), 0);
  EXPECT_EQ(WM.getSceneGraph().solidObjects(), WM.solidObjects());
}

TEST_F(UtilityTest, NormalPointsFromTheWallToTheMover) {
  Object wall;
  wall.setBox(Box(Vector(-3, -3), 6, 6));
  wall.setPosition(Vector(20, 10));
  PlacedObject ball(Vector(16.6, 11));
  EXPECT_EQ(getNormal(&ball, &wall), Vector(-1, 0));
  ball.setPosition(Vector(21, 13.2));
  EXPECT_EQ(getNormal(&ball, &wall), Vector(0, 1));
  ball.setPosition(Vector(30, 10));
  EXPECT_EQ(getNormal(&ball, &wall), Vector());
  ball.setPosition(Vector(20, 10));
  EXPECT_EQ(getNormal(&ball, &wall), Vector());
  EXPECT_EQ(getNormal(nullptr, &wall), Vector());
}

TEST_F(UtilityTest, AnglesGrowFromRightToDown) {
  EXPECT_FLOAT_EQ(vectorToAngle(Vector(2, 0)), 0);
  EXPECT_FLOAT_EQ(vectorToAngle(Vector(0, 1)), 90);
  EXPECT_FLOAT_EQ(vectorToAngle(Vector(-1, 0)), 180);
  EXPECT_FLOAT_EQ(vectorToAngle(Vector(1, -1)), 315);
  EXPECT_FLOAT_EQ(vectorToAngle(Vector()), 0);
}

TEST_F(UtilityTest, ColoursSurviveTheRgbRoundTrip) {
  for (int c = BLACK; c <= WHITE; ++c) {
    unsigned char r = 1;
    unsigned char g = 1;
    unsigned char b = 1;
    colorToRGB(static_cast<Color>(c), r, g, b);
    EXPECT_EQ(nearestColor(r, g, b), c);
  }
  EXPECT_EQ(nearestColor(100, 90, 10), YELLOW);
  EXPECT_EQ(nearestColor(128, 128, 128), WHITE);
  EXPECT_EQ(nearestColor(255, 100, 90), RED);
}

TEST_F(UtilityTest, ValuesConvertToText) {
  EXPECT_EQ(toString(7), "7");
  EXPECT_EQ(toString(2.5f), "2.5");
  EXPECT_EQ(toString('x'), "x");
  EXPECT_EQ(toString(true), "true");
  EXPECT_EQ(toString(MAGENTA), "magenta");
  EXPECT_EQ(toString(UNDEFINED_COLOR), "undefined");
  EXPECT_EQ(toString(SPECTRAL), "spectral");
  EXPECT_EQ(toString(BOTTOM_RIGHT), "bottom-right");
  EXPECT_EQ(toString(MessageType::CUSTOM_MESSAGE), "custom-message");
  EXPECT_EQ(toString(Keyboard::Q), "q");
  EXPECT_EQ(toString(Keyboard::NUM0), "0");
  EXPECT_EQ(toString(Keyboard::F10), "f10");
  EXPECT_EQ(toString(Keyboard::LEFTARROW), "left-arrow");
  EXPECT_EQ(toString(Keyboard::UNDEFINED_KEY), "undefined");
  EXPECT_EQ(maskToString(5).substr(29), "101");
  EXPECT_EQ(maskToString(5).size(), 32u);
  EXPECT_STREQ(getTimeString(), "00:00:00");
  EXPECT_EQ(characterOf(Keyboard::NUM9, false), '9');
  EXPECT_EQ(characterOf(Keyboard::NUM2, true), '@');
  EXPECT_EQ(characterOf(Keyboard::UPARROW, false), 0);
}

TEST_F(UtilityTest, TimeStringCountsTicksOfAnyLength) {
  struct {
    int frame_time;
    int ticks;
    const char* text;
  } const rows[] = {{33, 29, "00:00:00"},
                    {33, 30, "00:00:01"},
                    {100, 600, "00:01:00"},
                    {20, 49, "00:00:00"},
                    {20, 50, "00:00:01"}};
  for (const auto& row : rows) {
    World one;
    const World::Scope scope_of_one(one);
    one.extras().settings.frame_time = row.frame_time;
    for (int i = 0; i < row.ticks; ++i) one.tick();
    EXPECT_STREQ(getTimeString(), row.text) << row.frame_time;
  }
}

TEST_F(UtilityTest, MatchFindsValuesAndRemembersTheString) {
  EXPECT_EQ(match("a:1, bb : two words ,c:3", "bb"), "twowords");
  EXPECT_EQ(match("", "c"), "3");
  EXPECT_EQ(match("", "d"), "");
  EXPECT_EQ(match("aa:1,a:2", "a"), "2");
}

TEST_F(UtilityTest, FailedStreamIsReported) {
  std::stringstream stream;
  EXPECT_EQ(stringStreamCheck("test", &stream), 0);
  stream.setstate(std::ios::failbit);
  EXPECT_EQ(stringStreamCheck("test", &stream), -1);
  EXPECT_EQ(logged("test: the stream has failed"), 1);
}

TEST_F(UtilityTest, ClockFollowsGameTime) {
  Clock clock;
  for (int i = 0; i < 30; ++i) world.tick();
  EXPECT_NEAR(static_cast<double>(clock.split()), 1e6, 10);
  EXPECT_NEAR(static_cast<double>(clock.delta()), 1e6, 10);
  EXPECT_LT(clock.split(), 10);
  while (clock.split() < 1000) {  // a game that waits in a loop does not hang
  }
  world.tick();
  EXPECT_NEAR(static_cast<double>(clock.delta()), 1e6 / 30, 10);
}

struct Noted : State {
  std::string& notes;
  Noted(const std::string& name, std::string& n) : notes(n) { setType(name); }
  void Enter(Object*) override { notes += "+" + getType(); }
  void Execute(Object* p_o) override { notes += p_o->getType(); }
  void Exit(Object*) override { notes += "-" + getType(); }
};

TEST_F(UtilityTest, StateMachineEntersExecutesAndLeaves) {
  std::string notes;
  Noted calm("a", notes);
  Noted wild("b", notes);
  Object owner;
  owner.setType("o");
  StateMachine machine;
  machine.Update();
  machine.setOwner(&owner);
  machine.changeState(&calm);
  machine.Update();
  machine.changeState(&wild);
  machine.revertToPrevious();
  machine.changeState(nullptr);
  EXPECT_EQ(notes, "+ao-a+b-b+a");
  EXPECT_EQ(machine.getState(), &calm);
}

}  // namespace
}  // namespace df::test
